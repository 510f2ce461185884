#include "host/labeling/painting/painted_labels.h"

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {

void PaintedLabels::start_with(std::span<const std::int32_t> labels) {
    if (labels.size() != label_.size()) throw UsageError("labels and faces differ in number");
    label_.assign(labels.begin(), labels.end());
    painted_ = static_cast<std::size_t>(std::ranges::count_if(label_, [](std::int32_t label) { return label >= 0; }));
    steps_.clear();
    done_ = 0;
    ++version_;
}

void PaintedLabels::begin_step() {
    steps_.resize(done_);
    if (done_ > 0 && steps_.back().empty()) return;  // a click beside the mesh is no step
    steps_.emplace_back();
    done_ = steps_.size();
}

void PaintedLabels::set(std::uint32_t face, std::int32_t label) {
    if (label_[face] == k_unpainted) ++painted_;
    if (label == k_unpainted) --painted_;
    label_[face] = label;
}

void PaintedLabels::paint(std::span<const std::uint32_t> faces, std::int32_t label) {
    if (done_ == 0 || done_ < steps_.size()) begin_step();
    std::vector<Change>& step = steps_.back();
    for (const std::uint32_t face : faces) {
        if (label_[face] == label) continue;
        step.push_back({face, label_[face], label});
        set(face, label);
        ++version_;
    }
}

bool PaintedLabels::undo() {
    while (done_ > 0 && steps_[done_ - 1].empty()) --done_;
    if (done_ == 0) return false;
    const std::vector<Change>& step = steps_[--done_];
    for (auto change = step.rbegin(); change != step.rend(); ++change) set(change->face, change->before);
    ++version_;
    return true;
}

bool PaintedLabels::redo() {
    if (done_ == steps_.size()) return false;
    for (const Change& change : steps_[done_++]) set(change.face, change.after);
    ++version_;
    return true;
}

}  // namespace exemplar
