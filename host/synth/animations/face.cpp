#include "host/synth/animations/face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "host/synth/modeling/fairing.h"
#include "host/synth/modeling/surface.h"

namespace exemplar {
namespace {

constexpr double k_face_fairing = 0.06;  // width of the bumps to smooth: those where solids meet, not lips and eyes
constexpr float k_min_offset = 1e-6f;    // smaller offsets are left out, so that shapes stay sparse
constexpr double k_face_frame_rate = 30;

/// Returns the displacement of the skin at p by a push: a bump with three continuous derivatives.
Vec3 displacement(const SkinPush& push, const Vec3& p, const Vec3& normal) {
    const Vec3 local = (p - push.center).cwiseQuotient(push.radius);
    const float inside = 1 - local.squaredNorm();
    if (inside <= 0) return Vec3::Zero();
    const float bump = inside * inside * inside * inside;
    const float wave = std::cos(2 * std::numbers::pi_v<float> * push.across.dot(p - push.center) / push.fold_width);
    return bump * (push.shift + (push.swell + push.fold * wave) * normal);
}

MorphTarget target_of(const FaceShape& shape, const TriangleMesh& mesh, const std::vector<Vec3>& normals) {
    MorphTarget target{std::string(shape.name), {}, {}};
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        Vec3 offset = Vec3::Zero();
        for (const SkinPush& push : shape.pushes) offset += displacement(push, mesh.vertices[v], normals[v]);
        if (offset.norm() < k_min_offset) continue;
        target.vertices.push_back(v);
        target.offsets.push_back(offset);
    }
    return target;
}

/// Binds the whole head to one node.
void bind_to_one_node(Rig& rig, std::size_t vertex_count) {
    rig.nodes.push_back({"face", k_invalid_index, {}});
    rig.bones.push_back({});
    rig.influences.assign(vertex_count, {0, 1.0f});
    for (std::size_t v = 0; v <= vertex_count; ++v) rig.influence_begin.push_back(static_cast<std::uint32_t>(v));
}

/// Rises from 0 to 1 with two continuous derivatives that vanish at both ends.
double ease(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * t * (10 - 15 * t + 6 * t * t);
}

/// A shape whose weight rises, stays for some time and falls.
struct Expression {
    std::size_t shape;
    double begin, length, strength;

    double at(double time) const {
        const double t = (time - begin) / length;
        return strength * ease(t / 0.4) * ease((1 - t) / 0.4);
    }
};

/// Returns the same shape of the other side, which is next to it in the list; the shape itself if it has no partner.
std::size_t partner_of(const Rig& rig, std::size_t shape) {
    const std::string& name = rig.targets[shape].name;
    if (name.starts_with("jaw")) return shape;
    if (name.ends_with("Left")) return shape + 1;
    return name.ends_with("Right") ? shape - 1 : shape;
}

/// Adds one expression after the other, often for both sides of the face. Each shape is used once before any is
/// repeated.
void play(const Rig& rig, const std::vector<std::size_t>& shapes, double duration, Random random,
          std::vector<Expression>& played) {
    std::vector<std::size_t> waiting;
    for (double time = -random.uniform(0.3, 1.0); time < duration; time += random.uniform(0.45, 0.9)) {
        if (waiting.empty()) {
            waiting = shapes;
            random.shuffle(waiting);
        }
        const std::size_t shape = waiting.back(), partner = partner_of(rig, shape);
        waiting.pop_back();
        const double length = random.uniform(0.8, 1.6), strength = random.uniform(0.5, 1);
        played.push_back({shape, time, length, strength});
        if (partner != shape && random.uniform() < 0.7)
            played.push_back({partner, time, length, strength * random.uniform(0.7, 1)});
    }
}

/// Returns the shapes whose names begin with one of these.
std::vector<std::size_t> shapes_of(const Rig& rig, std::initializer_list<std::string_view> beginnings) {
    std::vector<std::size_t> found;
    for (std::size_t t = 0; t < rig.targets.size(); ++t)
        for (const std::string_view beginning : beginnings)
            if (rig.targets[t].name.starts_with(beginning)) found.push_back(t);
    return found;
}

}  // namespace

FaceModel sculpt_face(Random& random) {
    FaceModel m{};
    m.shape.detail = 0.02f;
    m.eye_x = pick(random, 0.135f, 0.155f);
    m.eye_y = pick(random, 0.05f, 0.07f);
    m.brow_y = m.eye_y + pick(random, 0.085f, 0.1f);
    m.nose_y = pick(random, -0.1f, -0.07f);
    m.mouth_x = pick(random, 0.1f, 0.125f);
    m.mouth_y = pick(random, -0.24f, -0.22f);
    m.chin_y = pick(random, -0.4f, -0.37f);
    const float jaw = pick(random, 0.2f, 0.25f), nose = pick(random, 0.85f, 1.2f), lips = pick(random, 0.85f, 1.2f);
    Sculptor add(m.shape);
    add.blend(0.12f);
    add.ellipsoid({Vec3(0, 0.11f, -0.04f)}, Vec3(0.35f, 0.39f, 0.42f));  // skull
    add.ellipsoid({Vec3(0, -0.14f, 0.06f)}, Vec3(0.27f, 0.3f, 0.3f));    // face
    add.limb(Vec3(-jaw * 0.6f, -0.31f, 0.12f), Vec3(jaw * 0.6f, -0.31f, 0.12f), 0.13f, 0.13f);
    add.ball(Vec3(0, m.chin_y, 0.27f), 0.07f);
    add.limb(Vec3(0, -0.3f, -0.12f), Vec3(0, -0.6f, -0.16f), 0.2f, 0.21f);  // neck
    add.blend(0.07f);
    for (const float s : {1.0f, -1.0f}) {
        add.limb(Vec3(s * 0.045f, m.brow_y, 0.352f), Vec3(s * 0.2f, m.brow_y + 0.015f, 0.298f), 0.034f, 0.022f);
        add.ellipsoid({Vec3(s * 0.17f, -0.05f, 0.24f)}, Vec3(0.1f, 0.085f, 0.1f));                    // cheekbone
        add.ellipsoid({Vec3(s * 0.355f, 0.02f, -0.06f), turn_y(s * 25)}, Vec3(0.035f, 0.1f, 0.07f));  // ear
    }
    add.blend(0.035f);
    for (const float s : {1.0f, -1.0f}) add.ball(Vec3(s * m.eye_x, m.eye_y, 0.272f), 0.083f);
    add.blend(0.05f);
    add.limb(Vec3(0, m.brow_y - 0.02f, 0.34f), Vec3(0, m.nose_y + 0.01f, 0.4f + 0.03f * nose), 0.028f, 0.042f * nose);
    for (const float s : {1.0f, -1.0f}) add.ball(Vec3(s * 0.047f * nose, m.nose_y, 0.375f), 0.034f * nose);
    add.blend(0.03f);
    for (const float s : {1.0f, -1.0f}) {
        add.limb(Vec3(0, m.mouth_y + 0.024f, 0.352f), Vec3(s * m.mouth_x, m.mouth_y + 0.006f, 0.318f), 0.026f * lips,
                 0.013f);
        add.limb(Vec3(0, m.mouth_y - 0.03f, 0.347f), Vec3(s * m.mouth_x * 0.9f, m.mouth_y - 0.008f, 0.318f),
                 0.03f * lips, 0.013f);
    }
    return m;
}

Clip move_face(const Rig& rig, std::size_t frames, const Random& random) {
    const double duration = static_cast<double>(frames) / k_face_frame_rate;
    std::vector<Expression> played;
    play(rig, shapes_of(rig, {"brow"}), duration, random.fork(1), played);
    play(rig, shapes_of(rig, {"eye"}), duration, random.fork(2), played);
    play(rig, shapes_of(rig, {"mouth"}), duration, random.fork(3), played);
    play(rig, shapes_of(rig, {"jaw", "cheek", "nose"}), duration, random.fork(4), played);
    Clip clip;
    clip.frames_per_second = k_face_frame_rate;
    for (std::size_t f = 0; f < frames; ++f) {
        // Expressions of one shape combine as 1 - product of (1 - weight), so that overlapping ones stay within [0,
        // 1].
        std::vector<double> left(rig.targets.size(), 1.0);
        for (const Expression& expression : played)
            left[expression.shape] *= 1 - expression.at(static_cast<double>(f) / k_face_frame_rate);
        Pose pose = rest_pose(rig);
        for (std::size_t t = 0; t < left.size(); ++t) pose.weights[t] = static_cast<float>(1 - left[t]);
        clip.poses.push_back(std::move(pose));
    }
    return clip;
}

Animation make_face(const AnimationOptions& options) {
    Random random(Random(options.shape_seed).fork(6));
    const FaceModel model = sculpt_face(random);
    const ImplicitField field(model.shape.primitives);
    Animation animation;
    animation.kind = AnimationKind::blend_shapes;
    animation.rest = mesh_surface(field, model.shape.detail, options.vertices);
    fair(animation.rest, k_face_fairing);
    bind_to_one_node(animation.rig, animation.rest.vertex_count());
    const std::vector<Vec3> normals = vertex_normals(animation.rest);
    for (const FaceShape& shape : face_shapes(model, field))
        animation.rig.targets.push_back(target_of(shape, animation.rest, normals));
    animation.clips.push_back(move_face(animation.rig, options.frames, Random(options.motion_seed).fork(7)));
    return animation;
}

}  // namespace exemplar
