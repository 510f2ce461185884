#include "gpu/curvature/animated_surface.h"

#include "host/core/errors.h"

namespace exemplar {

GpuAnimatedSurface::GpuAnimatedSurface(const GpuSurface& surface, const Animation& animation,
                                       const CurvatureOptions& options)
    : surface_(surface),
      rig_(animation.rig),
      options_(options),
      poser_(surface.device(), animation.rig, animation.rest.vertices),
      normals_(surface) {}

void GpuAnimatedSurface::set_model(const CurvatureModel& model) {
    learned_.emplace(surface_.device(), model);
}

void GpuAnimatedSurface::record(Stream& stream, const Pose& pose, CurvatureSource source) {
    poser_.record(stream, pose);
    pose_ = pose;
    record_curvature(stream, source);
}

void GpuAnimatedSurface::record(Stream& stream, std::span<const Vec3> vertices, CurvatureSource source) {
    poser_.set_vertices(stream, vertices);
    pose_.reset();
    frame_.assign(vertices.begin(), vertices.end());
    record_curvature(stream, source);
}

void GpuAnimatedSurface::record_again(Stream& stream, CurvatureSource source) {
    record_curvature(stream, source);
}

void GpuAnimatedSurface::record_curvature(Stream& stream, CurvatureSource source) {
    source_ = source;
    if (source == CurvatureSource::estimated) {
        if (!estimated_) estimated_.emplace(surface_, options_);
        estimated_->record(stream, vertices());
        return;
    }
    normals_.record(stream, vertices());
    if (source == CurvatureSource::none) return;
    if (!learned_) throw UsageError("no curvature has been learned for this surface; give a model, or estimate it");
    if (pose_)
        learned_->record(stream, rig_, *pose_, vertices(), normals());
    else
        learned_->record(stream, frame_, vertices(), normals());
}

const Buffer& GpuAnimatedSurface::normals() const {
    return source_ == CurvatureSource::estimated ? estimated_->normals() : normals_.normals();
}

GpuCurvedSurface GpuAnimatedSurface::snapshot() const {
    switch (source_) {
        case CurvatureSource::estimated:
            return {vertices(), normals(), &estimated_->first(), &estimated_->second(),
                    options_.derivatives ? &estimated_->derivative() : nullptr};
        case CurvatureSource::learned:
            return {vertices(), normals(), &learned_->first(), &learned_->second(), &learned_->derivative()};
        case CurvatureSource::none:
            break;
    }
    return {vertices(), normals()};
}

}  // namespace exemplar
