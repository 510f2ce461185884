#include "apps/exemplar/lines/frame_drawer.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "gpu/lines/device_style.h"
#include "gpu/lines/face_types.h"

namespace exemplar {
namespace {

CurvatureOptions measured_curvature(const LinesJob& job, const LinesSource& source) {
    if (source.model()) return source.model()->truth;
    return {.derivatives = true, .smoothing = job.source.measuring.curvature.smoothing};
}

/// Returns the pixels that differ visibly between two pictures of one size.
InkMask difference_of(const Image& a, const Image& b) {
    constexpr int k_visible = 16;  // of 255
    InkMask ink(a.width, a.height, 1);
    for (std::size_t i = 0; i < a.data.size(); ++i)
        if (std::abs(int{a.data[i]} - int{b.data[i]}) > k_visible)
            ink.data[i / static_cast<std::size_t>(a.channels)] = 1;
    return ink;
}

}  // namespace

FrameDrawer::FrameDrawer(const LinesJob& job, LinesSource& source, const StrokeView& view)
    : source_(source),
      device_({.name = job.common.device}),
      renderer_(device_, source.animation(), measured_curvature(job, source),
                source.model() ? &*source.model() : nullptr, job.source.measuring.crease_angle),
      stream_(device_) {
    renderer_.set_cut_curvature(job.source.measuring.cut_curvature);
    const DeviceStyle style = device_style(job.style);
    renderer_.view().set_textures(style.textures);
    renderer_.view().set_part_inks(source.inks());
    if (job.check) {  // for redraw()
        renderer_.view(1).set_textures(style.textures);
        renderer_.view(1).set_part_inks(source.inks());
    }
    picture_.view = view;
    apply_style(style, job.types, picture_);
}

Image FrameDrawer::draw(std::size_t frame) {
    return draw(frame, source_.model() ? CurvatureSource::learned : CurvatureSource::estimated);
}

Image FrameDrawer::draw(std::size_t frame, CurvatureSource from) {
    renderer_.record(stream_, source_.frames()[frame], from);
    Image image = renderer_.view().render(stream_, renderer_.snapshot(), picture_);
    flicker_.push_back(renderer_.view().coherence().flicker());
    if (picture_.families != 0) dropped_ = std::max(dropped_, renderer_.view().strokes().chains().lines().dropped());
    return image;
}

/// Draws the last surface in another view, so that textures in the first one stay where they are.
Image FrameDrawer::redraw(std::uint32_t families) {
    LinePicture picture = picture_;
    picture.families = families;
    return renderer_.view(1).render(stream_, renderer_.snapshot(), picture);
}

OutlineCheck FrameDrawer::check_outline_of(std::size_t frame) {
    const Image bare = redraw(0);
    const std::uint32_t contours = picture_.families & line_families(std::array{LineType::contours});
    return check_outline(source_.mesh(frame), picture_.view.camera, difference_of(redraw(picture_.families), bare),
                         difference_of(redraw(contours), bare));
}

LineFlicker FrameDrawer::flicker() const {
    LineFlicker mean;
    for (std::size_t i = 1; i < flicker_.size(); ++i) {
        const float share = 1 / static_cast<float>(flicker_.size() - 1);
        mean.drawn += share * flicker_[i].drawn;
        mean.appeared += share * flicker_[i].appeared;
        mean.slip += share * flicker_[i].slip;
        mean.stretch += share * flicker_[i].stretch;
    }
    return mean;
}

FaceTypes FrameDrawer::face_types() {
    return download_face_types(renderer_.view().strokes().chains().lines());
}

FaceTypes FrameDrawer::face_types_from(const Vec3& eye) {
    if (!elsewhere_) elsewhere_.emplace(renderer_.line_surface());
    elsewhere_->record(stream_, renderer_.snapshot(), picture_.families,
                       {.eye = {eye.x(), eye.y(), eye.z(), 1},
                        .feature_size = picture_.view.feature_size,
                        .thresholds = picture_.thresholds});
    stream_.finish();
    return download_face_types(*elsewhere_);
}

}  // namespace exemplar
