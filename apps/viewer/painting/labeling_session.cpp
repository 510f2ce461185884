#include "apps/viewer/painting/labeling_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/labeling/painting/painting_file.h"
#include "host/labeling/painting/shape_order.h"
#include "host/labeling/painting/suggestions.h"
#include "host/mesh/editing/drawable_mesh.h"

namespace exemplar {
namespace {

constexpr const char* k_model_name = "suggestions.safetensors";

/// Returns the model that was learned from the folder before; null if there is none that can be used.
std::shared_ptr<const LabelingModel> earlier_model(const LabelingFolder& folder) {
    const std::filesystem::path path = folder.shapes().front().path.parent_path() / k_model_name;
    if (folder.verified_count() == 0 || !std::filesystem::exists(path)) return nullptr;
    try {
        return std::make_shared<const LabelingModel>(load_model(path));
    } catch (const Error&) {  // it is replaced by what is learned now
        return nullptr;
    }
}

}  // namespace

LabelingSession::LabelingSession(const std::filesystem::path& source, std::filesystem::path cache,
                                 std::shared_ptr<const LabelingModel> model)
    : folder_(source), cache_(std::move(cache)), shapes_(folder_.shapes().size()), model_(std::move(model)) {
    remarks_ = folder_.warnings();
    if (!model_) model_ = earlier_model(folder_);
    if (model_) add_labels_of(*model_);
    const auto first = std::ranges::find(folder_.shapes(), false, &FolderShape::verified);
    const auto begun = std::ranges::find(folder_.shapes(), true, &FolderShape::begun);
    const auto start = begun != folder_.shapes().end() ? begun : first;
    open_shape(start == folder_.shapes().end() ? 0 : static_cast<std::size_t>(start - folder_.shapes().begin()));
    start_job(true);
}

void LabelingSession::add_labels_of(const LabelingModel& model) {
    std::vector<PaletteEntry> palette = folder_.palette();
    for (std::size_t c = 0; c < model.class_count(); ++c)
        if (std::ranges::find(palette, model.label_names[c], &PaletteEntry::name) == palette.end())
            palette.push_back({model.label_names[c], model.label_colors[c]});
    if (palette.size() > folder_.palette().size()) change_palette(std::move(palette));
}

void LabelingSession::use_model(std::shared_ptr<const LabelingModel> model) {
    model_ = std::move(model);
    add_labels_of(*model_);
    show_suggestion();
}

void LabelingSession::open_shape(std::size_t shape) {
    const MeshFile file = read_mesh(folder_.shapes()[shape].path);
    DrawableMesh drawable = drawable_mesh(file.mesh, folder_.shapes()[shape].path.string());
    auto painter = std::make_unique<LabelPainter>(file.mesh, std::move(drawable.mesh), cache_);
    const std::size_t faces = painter->face_count();
    try {
        if (const auto strokes = folder_.read_strokes(shape, faces))
            painter->start_with(*strokes);
        else if (folder_.shapes()[shape].verified)
            painter->start_with(folder_.read_labels(shape, faces));
        else if (const auto labels = folder_.read_other_labels(shape, file))
            painter->start_with(*labels);
    } catch (const Error& error) {
        remarks_.emplace_back(error.what());
    }
    painter_ = std::move(painter);
    shape_ = shape;
    painter_->set_label_count(palette().size());
    show_suggestion();
}

// The model's labels on the open shape, unless a person has labeled it already.
void LabelingSession::show_suggestion() {
    if (!model_ || folder_.shapes()[shape_].verified) return;
    std::vector<std::string> names;
    for (const PaletteEntry& entry : palette()) names.push_back(entry.name);
    painter_->suggest_by(model_, std::move(names));
}

ShapeState LabelingSession::state_of(std::size_t shape) const {
    if (folder_.shapes()[shape].verified) return ShapeState::verified;
    if (!shapes_[shape].error.empty()) return ShapeState::broken;
    return shapes_[shape].suggestion.empty() ? ShapeState::empty : ShapeState::suggested;
}

std::optional<std::size_t> LabelingSession::next_shape() const {
    std::vector<std::size_t> known;
    std::vector<ShapeDescriptor> descriptors;
    std::vector<float> uncertainty;
    std::optional<std::size_t> unknown;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        const bool waits = s != shape_ && !folder_.shapes()[s].verified && shapes_[s].error.empty();
        if (!shapes_[s].descriptor) {
            if (waits && !unknown) unknown = s;
            continue;
        }
        known.push_back(s);
        descriptors.push_back(*shapes_[s].descriptor);
        uncertainty.push_back(waits ? shapes_[s].uncertainty.value_or(1) : 0);
    }
    if (std::ranges::any_of(uncertainty, [](float u) { return u > 0; }))
        return known[order_by_gain(ShapeLikeness(descriptors), uncertainty, palette().size()).front()];
    return unknown;
}

std::vector<std::size_t> LabelingSession::to_verify() const {
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < shapes_.size(); ++s)
        if (state_of(s) == ShapeState::suggested && shapes_[s].rejected.empty()) order.push_back(s);
    std::ranges::stable_sort(order, {}, [&](std::size_t s) { return shapes_[s].uncertainty.value_or(1); });
    return order;
}

void LabelingSession::change_palette(std::vector<PaletteEntry> palette) {
    try {
        folder_.set_palette(std::move(palette));
    } catch (const DataError& error) {  // it holds for this session, and comes with the saved labels
        remarks_.emplace_back(error.what());
    }
    if (painter_) painter_->set_label_count(folder_.palette().size());
    ++settings_version;
}

void LabelingSession::add_label(const std::string& name, std::optional<Color> color) {
    std::vector<PaletteEntry> palette = folder_.palette();
    palette.push_back({checked_label_name(name), color.value_or(label_color(palette.size()))});
    change_palette(std::move(palette));
    settings.label = static_cast<std::int32_t>(folder_.palette().size()) - 1;
}

void LabelingSession::rename_label(std::size_t label, const std::string& name) {
    std::vector<PaletteEntry> palette = folder_.palette();
    palette.at(label).name = checked_label_name(name);
    change_palette(std::move(palette));
}

void LabelingSession::recolor_label(std::size_t label, const Color& color) {
    std::vector<PaletteEntry> palette = folder_.palette();
    palette.at(label).color = color;
    change_palette(std::move(palette));
}

void LabelingSession::keep_strokes() {
    try {
        const auto labels = painter_->painted().labels();
        folder_.save_strokes(shape_, {labels.begin(), labels.end()});
    } catch (const DataError& error) {
        remarks_.emplace_back(error.what());
    }
}

void LabelingSession::verify() {
    if (const std::size_t count = painter_->unlabeled_count(); count > 0)
        throw DataError(
            fmt::format("{} of {} faces have no label yet: paint each part", count, painter_->face_count()));
    folder_.save_labels(shape_, {painter_->labels().begin(), painter_->labels().end()});
    shapes_[shape_].uncertainty = 0;
    learn();
}

void LabelingSession::accept(std::size_t shape) {
    folder_.save_labels(shape, shapes_[shape].suggestion);
    shapes_[shape].uncertainty = 0;
}

void LabelingSession::learn() {
    if (folder_.verified_count() > learned_) start_job(false);
}

void LabelingSession::start_job(bool draws_thumbnails) {
    FolderWork work{folder_.shapes(), folder_.palette(), {}, cache_, {}, draws_thumbnails};
    if (folder_.shapes().size() > 1) work.model_file = path().parent_path() / k_model_name;
    for (const SessionShape& shape : shapes_) {
        work.described.push_back(shape.descriptor.has_value());
        if (!shape.thumbnail && shape.error.empty()) work.draws_thumbnails = true;
    }
    learned_ = folder_.verified_count();
    job_.reset();  // first, as both listen to the progress
    job_ = std::make_unique<FolderJob>(std::move(work));
}

void LabelingSession::collect(ShapeResult result) {
    SessionShape& shape = shapes_[result.shape];
    if (result.thumbnail) {
        shape.thumbnail = std::move(result.thumbnail);
        ++thumbnail_version_;
    }
    if (result.descriptor) shape.descriptor = std::move(result.descriptor);
    if (result.uncertainty) {
        shape.uncertainty = result.uncertainty;
        shape.suggestion = std::move(result.label);
        if (!much_the_same(shape.rejected, shape.suggestion)) shape.rejected.clear();
    }
    if (!result.error.empty()) shape.error = std::move(result.error);
}

bool LabelingSession::poll() {
    bool changed = painter_->poll(settings);
    if (std::string error = painter_->take_error(); !error.empty()) remarks_.push_back(std::move(error));
    if (!job_) return changed;
    const bool finished = job_->finished();  // before its results are taken, so that none is lost
    for (ShapeResult& result : job_->take_results()) collect(std::move(result)), changed = true;
    if (!finished) return changed;
    const std::unique_ptr<FolderJob> job = std::move(job_);
    try {
        if (std::shared_ptr<const LabelingModel> model = job->take()) {
            model_ = std::move(model);
            show_suggestion();
            remarks_.push_back("Learned from " + counted(learned_, "verified shape"));
        }
    } catch (const Interrupted&) {
        return true;
    } catch (const Error& error) {
        remarks_.emplace_back(error.what());
    } catch (const std::bad_alloc&) {
        remarks_.emplace_back("there is not enough memory to learn from these shapes");
    }
    return true;
}

}  // namespace exemplar
