#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/inference/labeler.h"
#include "host/labeling/painting/completion.h"
#include "host/labeling/training/training.h"

namespace exemplar {

/// Returns options of training that is repeated after every verified shape, in the background: a few thousand faces of
/// each mesh, two stages and a third of the rounds. It takes a fifth of the time of the defaults.
TrainOptions suggestion_training();

/// Leaves out the names of labels that no face has.
LabeledCorpus without_unused_labels(LabeledCorpus corpus);

/// Labels of a mesh as a model suggests them.
struct Suggestion {
    CompletedLabels labels;  ///< after the model's own graph cut
    LabelEvidence evidence;  ///< for a completion from strokes
};

/// Labels meshes by a model. Labels are turned into those of `palette` by name; labels of the model that the palette
/// lacks get no probability.
std::vector<Suggestion> suggest_labels(const LabelingModel& model, std::span<MeshFeatures* const> meshes,
                                       std::span<const std::string> palette, const LabelingBackend& backend);

/// Returns whether a suggestion that a person rejected is still much the same: fewer than one face in twenty has
/// another label in `now`.
bool much_the_same(std::span<const std::int32_t> rejected, std::span<const std::int32_t> now);

/// Returns 1 minus the mean confidence over the surface: how little is known about a shape.
float uncertainty_of(std::span<const float> face_area, std::span<const float> confidence);

}  // namespace exemplar
