#include "host/labeling/painting/folder_simulation.h"

#include <algorithm>
#include <numeric>

#include "host/core/interrupt.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_strokes = 100;  ///< on one shape: a person gives up

std::vector<ShapeDescriptor> descriptors_of(const std::vector<MeshFeatures>& features) {
    std::vector<ShapeDescriptor> descriptors;
    descriptors.reserve(features.size());
    for (const MeshFeatures& mesh : features) descriptors.push_back(compute_shape_descriptor(mesh));
    return descriptors;
}

}  // namespace

/// A shape as the person sees it.
struct FolderSimulation::Shape {
    SimulatedPerson person;
    LabelCompletion completion;
    std::vector<std::int32_t> shown;
    std::vector<std::int32_t> rejected{};  ///< labels that the person rejected in the grid; empty: none
    float uncertainty = 1;
    bool verified = false;
    double right = 0;
};

double SimulationResult::seconds_until(double right) const {
    for (const SimulationState& state : states)
        if (state.right >= right) return state.seconds;
    return states.empty() ? 0 : states.back().seconds;
}

FolderSimulation::FolderSimulation(const LabeledCorpus& truth, std::vector<MeshFeatures>& features,
                                   const LabelingBackend& backend, const SimulationOptions& options,
                                   std::function<void(const SimulationState&)> progress)
    : truth_(truth),
      features_(features),
      backend_(backend),
      options_(options),
      progress_(std::move(progress)),
      likeness_(descriptors_of(features)) {
    random_order_.resize(truth.meshes.size());
    std::iota(random_order_.begin(), random_order_.end(), std::size_t{0});
    Random(options.seed).shuffle(random_order_);
}

FolderSimulation::~FolderSimulation() = default;

void FolderSimulation::note(double seconds) {
    now_.seconds += seconds;
    now_.right = 0;
    for (const Shape& shape : shapes_) now_.right += shape.right / static_cast<double>(shapes_.size());
    result_.states.push_back(now_);
    if (progress_) progress_(now_);
}

void FolderSimulation::mend(Shape& shape) {
    if (shape.right > 0 && shape.right < options_.discarded) {  // a glance shows that most of it is wrong
        shape.completion.set_evidence({});
        shape.shown.assign(shape.shown.size(), -1);
        shape.right = 0;
        note(options_.costs.verify);
    }
    std::vector<std::int32_t> painted(shape.shown.size(), -1);
    for (std::size_t stroke = 0; stroke < k_max_strokes && shape.right < options_.quality; ++stroke) {
        const std::optional<PersonStroke> next = shape.person.next_stroke(shape.shown);
        if (!next) break;
        for (const std::uint32_t face : next->faces) painted[face] = next->label;
        shape.shown = shape.completion.complete(painted, truth_.names.size()).label;
        shape.right = shape.person.right(shape.shown);
        ++now_.strokes;
        note(options_.costs.stroke);
    }
}

void FolderSimulation::verify(Shape& shape) {
    shape.verified = true;
    shape.uncertainty = 0;
    ++now_.verified;
    note(options_.costs.verify);
}

// Trains on the verified shapes and suggests labels of the others.
void FolderSimulation::suggest_all() {
    LabeledCorpus corpus{truth_.names, {}, {}};
    std::vector<MeshFeatures> training;
    std::vector<MeshFeatures*> others;
    std::vector<std::size_t> other;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        if (!shapes_[s].verified) {
            others.push_back(&features_[s]);
            other.push_back(s);
            continue;
        }
        corpus.meshes.push_back(truth_.meshes[s]);
        corpus.meshes.back().label = shapes_[s].shown;
        training.push_back(features_[s]);
    }
    corpus = without_unused_labels(std::move(corpus));
    if (others.empty() || corpus.names.size() < 2) return;
    TrainOptions options = suggestion_training();
    options.seed = options_.seed;
    TrainReport report;
    const LabelingModel model = train_labeling(corpus, training, options, backend_, report);
    std::vector<Suggestion> suggestions = suggest_labels(model, others, truth_.names, backend_);
    for (std::size_t i = 0; i < other.size(); ++i) {
        drop_context_columns(*others[i]);
        Shape& shape = shapes_[other[i]];
        shape.shown = std::move(suggestions[i].labels.label);
        shape.uncertainty = std::max(uncertainty_of(others[i]->face_area, suggestions[i].labels.confidence), 1e-3F);
        shape.right = shape.person.right(shape.shown);
        shape.completion.set_evidence(std::move(suggestions[i].evidence));
    }
    note(0);
}

// The person accepts suggested shapes that are right, most certain first, until too many are not.
void FolderSimulation::look_through_grid() {
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < shapes_.size(); ++s)
        if (!shapes_[s].verified && !much_the_same(shapes_[s].rejected, shapes_[s].shown)) order.push_back(s);
    std::ranges::stable_sort(order, {}, [&](std::size_t s) { return shapes_[s].uncertainty; });
    std::size_t rejections = 0;
    for (const std::size_t s : order) {
        if (rejections == options_.rejections) return;
        if (shapes_[s].right >= options_.quality)
            verify(shapes_[s]);
        else
            shapes_[s].rejected = shapes_[s].shown, ++rejections, note(options_.costs.verify);
    }
}

std::size_t FolderSimulation::choose(LabelingWay way) {
    if (way == LabelingWay::order_by_gain) {
        std::vector<float> uncertainty;
        uncertainty.reserve(shapes_.size());
        for (const Shape& shape : shapes_) uncertainty.push_back(shape.uncertainty);
        return order_by_gain(likeness_, uncertainty, truth_.names.size(), options_.costs).front();
    }
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
        const std::size_t s = way == LabelingWay::random_order ? random_order_[i] : i;
        if (!shapes_[s].verified) return s;
    }
    return 0;
}

SimulationResult FolderSimulation::run(LabelingWay way) {
    result_ = {};
    now_ = {};
    shapes_.clear();
    shapes_.reserve(truth_.meshes.size());
    for (std::size_t m = 0; m < truth_.meshes.size(); ++m) {
        const LabeledMesh& mesh = truth_.meshes[m];
        shapes_.push_back({SimulatedPerson(mesh.mesh, mesh.label, options_.person), LabelCompletion(mesh.mesh), {}});
        shapes_.back().completion.set_descriptors(face_descriptors(features_[m]));
        shapes_.back().shown.assign(mesh.label.size(), -1);
    }
    while (now_.verified < shapes_.size() && now_.right < options_.quality) {
        check_interrupt();
        Shape& shape = shapes_[choose(way)];
        note(options_.costs.open);
        mend(shape);
        verify(shape);
        if (way == LabelingWay::each_alone) continue;
        suggest_all();
        const std::size_t before = now_.verified;
        look_through_grid();
        if (now_.verified > before) suggest_all();
    }
    return result_;
}

}  // namespace exemplar
