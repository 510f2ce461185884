// Members of ViewerState for painting labels.

#include <fmt/format.h>

#include <algorithm>

#include "apps/viewer/scene/viewer_state.h"
#include "host/core/errors.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {
namespace {

/// Returns a painted mesh as a document. Its faces are those that the painter colors.
std::unique_ptr<Document> document_of(const LabelingSession& session) {
    auto document = std::make_unique<Document>();
    document->path = session.path();
    document->animation.name = session.path().filename().string();
    document->animation.rest = session.painter().shown_mesh();
    document->face_colors = session.painter().face_colors(session.palette(), session.settings);
    return document;
}

}  // namespace

void ViewerState::start_labeling(const std::filesystem::path& source, const std::filesystem::path& model,
                                 ViewSize view) {
    std::shared_ptr<const LabelingModel> learned;
    if (!model.empty()) learned = std::make_shared<const LabelingModel>(load_model(model));
    auto session = std::make_unique<LabelingSession>(source, default_feature_folder(), std::move(learned));
    auto document = document_of(*session);
    labeling = std::move(session);
    settings.lines.fill(false);  // they are in the way of painting, and take time
    show_document(std::move(document), view);
    show_labels();
}

void ViewerState::open_shape(std::size_t shape, ViewSize view) {
    labeling->open_shape(shape);
    show_grid = false;
    show_document(document_of(*labeling), view);
    show_labels();
}

// Gives the document the colors and the legend of the painted labels.
void ViewerState::show_labels() {
    document_->face_colors = labeling->painter().face_colors(labeling->palette(), labeling->settings);
    ++document_->colors_version;
    document_->legend.clear();
    for (const PaletteEntry& entry : labeling->palette()) document_->legend.push_back({entry.name, entry.color});
    shown_labels_ = labeling->painter().version() + labeling->settings_version;
}

bool ViewerState::collect_labeling() {
    if (!labeling) return false;
    const bool changed = labeling->poll();
    for (std::string& remark : labeling->take_remarks()) messages.remark(std::move(remark));
    if (shown_labels_ != labeling->painter().version() + labeling->settings_version) show_labels();
    return changed;
}

void ViewerState::show_uncertain_place() {
    if (!labeling) return;
    if (const auto place = labeling->painter().next_uncertain_place())
        camera.look_at_place(place->point, place->normal);
    else
        messages.remark("No uncertain place is left on this shape");
}

void ViewerState::try_labeling(const std::function<void()>& edit) {
    try {
        edit();
    } catch (const Error& error) {
        messages.error(error.what());
    }
}

// Undo, redo and mirror image: the strokes are kept in a file after each.
void ViewerState::edit_strokes(Action action) {
    LabelPainter& painter = labeling->painter();
    if (action == Action::undo) painter.undo();
    if (action == Action::redo) painter.redo();
    if (action == Action::paint_mirror_image && painter.mirror() == 0)
        messages.remark("Nothing to mirror: this shape has no plane of symmetry, or both sides are painted");
    labeling->keep_strokes();
}

// Accepts, rejects or opens the first shape of the grid, while it is shown.
void ViewerState::check_first_suggestion(Action action, ViewSize view) {
    const std::vector<std::size_t> shapes = labeling->to_verify();
    if (!show_grid || shapes.empty()) return;
    if (action == Action::accept_shape) labeling->accept(shapes.front());
    if (action == Action::reject_shape) labeling->reject(shapes.front());
    if (action == Action::open_suggested) open_shape(shapes.front(), view);
}

void ViewerState::perform_labeling(Action action, ViewSize view) {
    constexpr float k_wider = 1.25F;
    PaintSettings& paint = labeling->settings;
    ++labeling->settings_version;
    if (action >= Action::label_1 && action <= Action::label_9) {
        const auto label = static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::label_1);
        if (label < labeling->palette().size()) paint.label = static_cast<std::int32_t>(label);
        if (paint.tool == PaintTool::eraser) paint.tool = PaintTool::brush;
    }
    if (action == Action::undo || action == Action::redo || action == Action::paint_mirror_image) edit_strokes(action);
    if (action == Action::brush) paint.tool = PaintTool::brush;
    if (action == Action::eraser) paint.tool = PaintTool::eraser;
    if (action == Action::lasso) paint.tool = PaintTool::lasso;
    if (action == Action::fill) paint.tool = PaintTool::fill;
    if (action == Action::wider_brush) paint.radius = std::min(paint.radius * k_wider, 200.0F);
    if (action == Action::narrower_brush) paint.radius = std::max(paint.radius / k_wider, 1.0F);
    if (action == Action::paint_through) paint.through = !paint.through;
    if (action == Action::show_confidence) paint.confidence = !paint.confidence;
    if (action == Action::uncertain_place) show_uncertain_place();
    if (action == Action::discard_suggestion && !labeling->painter().discard_suggestion())
        messages.remark("There are no suggested labels on this shape");
    if (action == Action::verify) verify_shape(view);
    if (action == Action::shape_grid) {
        show_grid = !show_grid;
        if (!show_grid) labeling->learn();  // from what was accepted
    }
    if (action >= Action::accept_shape) try_labeling([&] { check_first_suggestion(action, view); });
    if (action == Action::next_shape)
        if (const auto next = labeling->next_shape()) try_labeling([&] { open_shape(*next, view); });
}

void ViewerState::verify_shape(ViewSize view) {
    if (!labeling) return;
    try_labeling([&] {
        labeling->verify();
        messages.remark(fmt::format("Saved the labels of {}", labeling->path().filename().string()));
        if (const auto next = labeling->next_shape())
            open_shape(*next, view);
        else
            messages.remark("All shapes are verified");
    });
}

}  // namespace exemplar
