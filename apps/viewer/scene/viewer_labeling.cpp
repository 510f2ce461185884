// What the viewer's state does while labels are painted.

#include <fmt/format.h>

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
