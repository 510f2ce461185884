#include "apps/viewer/painting/paint_gesture.h"

#include "host/core/errors.h"
#include "host/imaging/scan_conversion.h"

namespace exemplar {
namespace {

constexpr float k_fill_reach = 4;  ///< pixels beside the mesh where a click still fills

bool paints_along_way(const LabelingSession& session) {
    return session.settings.tool == PaintTool::brush || session.settings.tool == PaintTool::eraser;
}

}  // namespace

void PaintGesture::press(LabelingSession& session, const FacePicture& picture, const Vec2& at) {
    if (session.palette().empty() && session.settings.tool != PaintTool::eraser)
        throw UsageError("there is no label to paint with: add one first");
    active_ = true;
    way_ = {at};
    if (session.settings.tool == PaintTool::fill) {
        const std::uint32_t face = face_near(picture, at, k_fill_reach);
        if (face != k_no_face) session.painter().fill(face, session.settings.label);
    }
    if (!paints_along_way(session)) return;
    session.painter().begin_stroke();
    session.painter().brush(picture, session.settings, at, at);
}

void PaintGesture::drag(LabelingSession& session, const FacePicture& picture, const Vec2& to) {
    if (!active_ || to == way_.back()) return;
    if (paints_along_way(session)) session.painter().brush(picture, session.settings, way_.back(), to);
    way_.push_back(to);
}

void PaintGesture::release(LabelingSession& session, const FacePicture& picture) {
    if (!active_) return;
    active_ = false;
    if (session.settings.tool == PaintTool::lasso) session.painter().lasso(picture, session.settings, way_);
    way_.clear();
    session.keep_strokes();
}

}  // namespace exemplar
