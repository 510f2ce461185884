#include "host/hatching/style/segment_learning.h"

namespace exemplar {

LearnedSegments learn_segments(const ExampleFeatures& features, const ExampleFolds& folds,
                               const SegmentTraining& training, const std::function<void()>& progress) {
    LearnedSegments learned;
    double last_error = 2;
    for (std::size_t stage = 0; stage < training.max_stages; ++stage) {
        // The first stage has no context.
        const std::size_t segments = stage > 0 ? training.segments : 0;
        const SegmentContext context{segments, learned.probabilities}, unseen{segments, learned.unseen};
        const FeatureMatrix matrix = features.of_rows(training.rows, unseen);
        const ClassifierTraining rows{.features = matrix,
                                      .labels = training.segment,
                                      .weights = {},
                                      .held_out = training.held_out,
                                      .classes = training.segments,
                                      .seed = training.seed + stage};
        const LearnedClassifier all = learn_classifier(rows, progress);
        learned.errors.push_back(all.error);
        if (all.error >= last_error) break;
        last_error = all.error;
        learned.cascade.push_back(all.classifier);
        if (training.segments < 2) {
            learned.probabilities = learned.unseen = features.probabilities(all.classifier, context);
            break;
        }
        std::vector<float> probabilities = features.probabilities(all.classifier, context);
        learned.unseen = folds.unseen_probabilities(rows, training.rows, all.classifier, unseen, progress);
        learned.probabilities = std::move(probabilities);
    }
    return learned;
}

}  // namespace exemplar
