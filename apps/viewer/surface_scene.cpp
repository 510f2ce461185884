#include "apps/viewer/surface_scene.h"

#include <algorithm>

#include "apps/viewer/picture.h"
#include "host/mesh/curvature_estimator.h"

namespace exemplar {
namespace {

// As many curvatures are measured with; see CurvatureTraining.
constexpr CurvatureOptions k_measured{.derivatives = false, .smoothing = 1};

// A shape the surface has; the rest mesh of a rig need not be one.
TriangleMesh first_shape(const Document& document) {
    TriangleMesh mesh = document.animation.rest;
    mesh.vertices = vertices_at(document, moment_of(document, 0, 0));
    return mesh;
}

float measured_feature_size(const TriangleMesh& mesh) {
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    return feature_size(mesh.vertices, estimator.estimate(mesh.vertices, k_measured));
}

Buffer packed_colors(Device& device, const std::vector<Color>& colors) {
    if (colors.empty()) return {};
    std::vector<std::uint32_t> packed;
    packed.reserve(colors.size());
    for (const Color& color : colors)
        packed.push_back(color[0] | std::uint32_t{color[1]} << 8 | std::uint32_t{color[2]} << 16);
    return Buffer::of<std::uint32_t>(device, packed);
}

}  // namespace

Moment moment_of(const Document& document, std::size_t clip, std::size_t frame) {
    const Animation& animation = document.animation;
    const bool exists = clip < animation.clips.size() && frame < animation.clips[clip].size();
    if (document.posable()) return {exists ? animation.clips[clip].poses[frame] : rest_pose(animation.rig)};
    if (!exists) return {};
    return {.pose = {}, .vertices = animation.clips[clip].frames[frame]};
}

std::vector<Vec3> vertices_at(const Document& document, const Moment& moment) {
    const Animation& animation = document.animation;
    std::vector<Vec3> vertices;
    if (moment.pose)
        pose_vertices(animation.rig, animation.rest.vertices, *moment.pose, vertices);
    else if (moment.vertices.empty())
        vertices = animation.rest.vertices;
    else
        vertices.assign(moment.vertices.begin(), moment.vertices.end());
    return vertices;
}

SurfaceScene::SurfaceScene(Device& device, const Document& document)
    : document_(document),
      device_(device),
      surface_(device, first_shape(document)),
      poser_(device, document.animation.rig, document.animation.rest.vertices),
      normals_(surface_),
      painter_(device, Picture::k_color, depth_format(device)),
      colors_(packed_colors(device, document.face_colors)) {}

void SurfaceScene::set_model(std::shared_ptr<const CurvatureModel> model) {
    std::optional<GpuLearnedCurvature> learned;
    if (model) {
        require_fit(*model, document_.animation);
        learned.emplace(device_, *model);
    }
    learned_ = std::move(learned);
    model_ = std::move(model);
    estimated_.reset();  // what was learned is measured as in training
}

void SurfaceScene::make_estimator() {
    if (estimated_) return;
    CurvatureOptions options = model_ ? model_->truth : k_measured;
    options.derivatives = false;
    options.robust = RobustEstimator::none;  // which the device does not have
    estimated_.emplace(surface_, options);
    feature_size_ = model_ ? model_->feature_size : measured_feature_size(surface_.rest());
}

const Buffer& SurfaceScene::normals() const {
    return estimates_ ? estimated_->normals() : normals_.normals();
}

void SurfaceScene::record_learned(Stream& stream, const Moment& moment) {
    if (moment.pose)
        learned_->record(stream, document_.animation.rig, *moment.pose, poser_.vertices(), normals());
    else if (model_->state.is_local())
        learned_->record(stream, poser_.vertices(), normals());
    else
        learned_->record(stream, moment.vertices, poser_.vertices(), normals());
}

void SurfaceScene::record_moment(Stream& stream, const Moment& moment, const ViewSettings& settings) {
    if (moment.pose)
        poser_.record(stream, *moment.pose);
    else if (!moment.vertices.empty())
        poser_.set_vertices(stream, moment.vertices);
    const bool needs = settings.needs_curvature();
    estimates_ = needs && (settings.source != CurvatureSource::learned || !has_model());
    if (needs) make_estimator();
    if (estimates_)
        estimated_->record(stream, poser_.vertices());
    else
        normals_.record(stream, poser_.vertices());
    if (needs && has_model() && settings.source != CurvatureSource::estimated) record_learned(stream, moment);
}

void SurfaceScene::draw(Pass& pass, const Camera& camera, const ViewSettings& settings, bool learned) {
    PaintedSurface painted{.face_count = surface_.face_count(),
                           .faces = &surface_.faces(),
                           .vertices = &poser_.vertices(),
                           .normals = &normals()};
    SurfaceLook look{.paint = settings.paint, .light = settings.light, .plain = settings.plain};
    if (colors_) painted.colors = &colors_;
    if (look.paint == SurfacePaint::faces && !colors_) look.paint = SurfacePaint::plain;
    if (paints_curvature(look.paint)) {
        painted.first = learned ? &learned_->first() : &estimated_->first();
        painted.second = learned ? &learned_->second() : &estimated_->second();
        look.strongest_curvature = settings.curvature_range / std::max(feature_size_, 1e-20f);
    }
    painter_.draw(pass, painted, camera, look);
}

}  // namespace exemplar
