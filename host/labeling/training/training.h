#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/data/corpus.h"
#include "host/labeling/training/crf_learning.h"
#include "host/labeling/training/fold_boosting.h"
#include "host/labeling/inference/labeler.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

/// Of what equal meshes and options give; to be raised with every change of the learning.
constexpr int k_training_version = 4;

struct TrainOptions {
    std::uint64_t seed = 1;
    std::size_t rounds = 300;        ///< stumps per classifier (thesis Sec. 3.3.1); at most, for boundaries
    std::size_t patience = 50;       ///< rounds without a lower held-out loss that end a boundary classifier
    std::size_t max_stages = 3;      ///< most classifiers of the unary cascade (thesis Sec. 3.3.1: usually 3)
    std::size_t bins = 128;          ///< quantization of each feature
    std::size_t rows_per_mesh = 0;   ///< faces (and edges) of each mesh used for boosting, drawn at random; 0 = all
    double feature_fraction = 0.06;  ///< share of the features that each round looks at, drawn at random
    double shrinkage = 0.5;          ///< what each stump's response is multiplied with
    bool linear = true;              ///< pool face classifiers with linear ones where that lowers the held-out loss
    FeatureOptions features;
};

/// How one classifier of a cascade was trained.
struct StageReport {
    std::string what;             ///< "unary 0", "pairwise 1", ...
    std::size_t rounds = 0;       ///< of each of the classifiers that it is the mean of
    double validation_loss = 0;   ///< weighted log loss, out of fold (see calibrate); NaN if nothing could be held out
    double stumps_loss = 0;       ///< the same of the stumps alone
    double validation_error = 0;  ///< weighted share of wrong labels, out of fold
    bool kept = true;             ///< false for a last stage that did not improve
    std::vector<HeldOutPoint> curve;  ///< of the held-out items, over the rounds
    double seconds = 0;
};

struct TrainReport {
    std::vector<StageReport> stages;
    CrfSearchReport crf;
    double crf_seconds = 0;
    std::vector<std::vector<std::string>> folds;  ///< mesh names per fold
};

/// Trains a labeler from labeled meshes and their features (one per mesh, same order; they gain contextual columns).
///
/// The exemplar/validation split of thesis Sec. 3.3 (4 : 1) is rotated: the meshes fall at random (by seed) into up to
/// five folds; for each fold a classifier is trained on the others and validated on it. The probabilities that each
/// mesh gets from the classifier that never saw it feed the contextual features of the next stage, the choice of the
/// number of stages, the link between score and probability, and the CRF's parameters; their log loss chooses the
/// number of rounds of the boundary classifiers, and whether and how the classifiers of faces are pooled with linear
/// ones (LinearOpinion), which the thesis does not have. The final classifiers are the mean of those of the folds and
/// one trained on all meshes. With 2 to 4 meshes there are as many folds as meshes; a single mesh is cut into patches
/// of faces that serve as folds. What is said of labels that one fold has alone cannot be validated, nor is there
/// context to learn from: for these the mean of all stages counts.
///
/// Throws DataError if there is no mesh, no labeled face, or more than k_max_classes labels.
LabelingModel train_labeling(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features,
                             const TrainOptions& options, const LabelingBackend& backend, TrainReport& report);

}  // namespace exemplar
