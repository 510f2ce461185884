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

void GpuAnimatedSurface::record(Stream& stream, const SurfaceShape& shape, CurvatureSource source) {
    if (shape.pose)
        poser_.record(stream, *shape.pose);
    else
        poser_.set_vertices(stream, shape.vertices);
    pose_ = shape.pose;
    frame_.assign(shape.vertices.begin(), shape.vertices.end());
    record_again(stream, source);
}

void GpuAnimatedSurface::record_again(Stream& stream, CurvatureSource source) {
    source_ = source;
    if (source == CurvatureSource::estimated) {
        if (!estimated_) estimated_.emplace(surface_, options_);
        estimated_->record(stream, poser_.vertices());
        return;
    }
    normals_.record(stream, poser_.vertices());
    if (source == CurvatureSource::none) return;
    if (!learned_) throw UsageError("no curvature has been learned for this surface; give a model, or estimate it");
    learned_->record(stream, {.vertices = poser_.vertices(),
                              .normals = normals(),
                              .rig = &rig_,
                              .pose = pose_ ? &*pose_ : nullptr,
                              .host_vertices = frame_});
}

const Buffer& GpuAnimatedSurface::normals() const {
    return source_ == CurvatureSource::estimated ? estimated_->normals() : normals_.normals();
}

GpuCurvedSurface GpuAnimatedSurface::snapshot() const {
    switch (source_) {
        case CurvatureSource::estimated:
            return {poser_.vertices(), normals(), &estimated_->first(), &estimated_->second(),
                    options_.derivatives ? &estimated_->derivative() : nullptr};
        case CurvatureSource::learned:
            return {poser_.vertices(), normals(), &learned_->first(), &learned_->second(), &learned_->derivative()};
        case CurvatureSource::none:
            break;
    }
    return {poser_.vertices(), normals()};
}

}  // namespace exemplar
