#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/data/corpus.h"
#include "host/labeling/inference/labeler.h"
#include "host/labeling/inference/model.h"
#include "host/labeling/training/crf_learning.h"
#include "host/labeling/training/fold_boosting.h"
#include "host/labeling/training/training_features.h"

namespace exemplar {

/// Version of the training; raise it with every change that alters the model of equal meshes and options.
constexpr int k_training_version = 7;

/// Whether faces are also classified by where they are (App. A.1h).
enum class OrientationUse {
    automatic,  ///< if that lowers the held-out loss clearly: the meshes are oriented alike
    always,
    never
};

/// Returns "auto", "yes" and "no".
std::vector<std::string> orientation_uses();
/// Returns the use of a name of orientation_uses. Throws UsageError for another name.
OrientationUse orientation_use(const std::string& name);

struct TrainOptions {
    std::uint64_t seed = 1;
    std::size_t rounds = 300;    ///< stumps per classifier (thesis Sec. 3.3.1); a maximum for boundary classifiers
    std::size_t patience = 50;   ///< boundary classifiers end after this many rounds without a lower held-out loss
    std::size_t max_stages = 3;  ///< maximum classifiers of the unary cascade (thesis Sec. 3.3.1: usually 3)
    std::size_t bins = 128;      ///< quantization bins of each feature
    /// Faces, and edges, of each mesh used for boosting, drawn at random, but small labels in full; 0 = all.
    /// Neighboring faces are alike: more hardly tell more.
    std::size_t rows_per_mesh = 4000;
    double feature_fraction = 0.06;  ///< share of the features that are tried in each round, drawn at random
    double shrinkage = 0.5;          ///< factor on each stump's response
    bool linear = true;              ///< combine face classifiers with linear ones if that lowers the held-out loss
    bool boundary = true;            ///< learn where parts end; otherwise any edge may be a border (thesis Fig. 3.2)
    OrientationUse orientation = OrientationUse::automatic;
    FeatureOptions features;
};

/// How one classifier of a cascade was trained.
struct StageReport {
    std::string what;             ///< "unary 0", "pairwise 1", ...
    std::size_t rounds = 0;       ///< stumps of each classifier in the mean
    double validation_loss = 0;   ///< weighted log loss, out of fold (see calibrate); NaN if nothing could be held out
    double stumps_loss = 0;       ///< the same for the stumps alone
    double validation_error = 0;  ///< weighted share of wrong labels, out of fold
    bool kept = true;             ///< false for a last stage that did not improve
    std::vector<HeldOutPoint> curve;  ///< held-out loss and error over the rounds
    double seconds = 0;
};

struct TrainReport {
    std::vector<StageReport> stages;
    CrfSearchReport crf;
    double crf_seconds = 0;
    std::vector<std::vector<std::string>> folds;  ///< mesh names per fold
};

/// Trains a labeler from labeled meshes and their features (one per mesh, same order). The model does not depend on how
/// many features are kept in memory.
///
/// The 4 : 1 split of thesis Sec. 3.3 is rotated over up to five folds of meshes, drawn at random (by seed); with 2
/// to 4 meshes each is a fold, a single mesh is cut into patches of faces. The out-of-fold probabilities of each
/// mesh feed the context of the next stage, and choose the number of stages, the link, the CRF's parameters, the
/// rounds of the boundary classifiers, and whether and how linear classifiers (LinearExpert, not in the thesis) are
/// combined with those of faces. The final classifiers are the mean of those of the folds and one trained on all
/// meshes. Labels that occur in one fold only cannot be validated: their probability is the mean over all stages.
/// docs/labeling.md explains the choices.
///
/// Throws DataError if there is no mesh, no labeled face, or fewer than two or more than k_max_classes labels.
LabelingModel train_labeling(const LabeledCorpus& corpus, TrainingFeatures& features, const TrainOptions& options,
                             const LabelingBackend& backend, TrainReport& report);
/// The same with all features in memory; they gain contextual columns.
LabelingModel train_labeling(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features,
                             const TrainOptions& options, const LabelingBackend& backend, TrainReport& report);

}  // namespace exemplar
