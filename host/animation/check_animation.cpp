#include "host/animation/check_animation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/editing/merge_coincident_faces.h"
#include "host/mesh/editing/orient_faces.h"
#include "host/mesh/editing/remove_faces.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

using mesh_io::quote;

/// Checks that the parts of a rig fit together and are finite.
class RigCheck {
  public:
    explicit RigCheck(const Animation& animation) : animation_(animation), rig_(animation.rig) {}

    void check() const {
        for (std::size_t i = 0; i < rig_.nodes.size(); ++i) {
            if (rig_.nodes[i].parent != k_invalid_index && rig_.nodes[i].parent >= i)
                fail(fmt::format("node {} comes before its parent", i));
            if (!is_finite(rig_.nodes[i].rest))
                fail(fmt::format("the place of node {} ({}) is not finite", i, quote(rig_.nodes[i].name)));
        }
        for (std::size_t i = 0; i < rig_.bones.size(); ++i) {
            if (rig_.bones[i].node >= rig_.nodes.size())
                fail(fmt::format("bone {} names node {} of {}", i, rig_.bones[i].node, rig_.nodes.size()));
            if (!rig_.bones[i].inverse_bind.matrix().allFinite())
                fail(fmt::format("the inverse bind matrix of bone {} is not finite", i));
        }
        for (const MorphTarget& target : rig_.targets) check_target(target);
    }

    static bool is_finite(const NodeTransform& t) {
        return t.translation.allFinite() && t.rotation.coeffs().allFinite() && t.scale.allFinite();
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw MeshError(animation_.name + ": " + message); }

    void check_target(const MorphTarget& target) const {
        const std::string name = quote(target.name);
        if (target.vertices.size() != target.offsets.size())
            fail(fmt::format("morph target {} has {} offsets for {} vertices", name, target.offsets.size(),
                             target.vertices.size()));
        if (!std::isfinite(target.rest_weight)) fail(fmt::format("the weight of morph target {} is not finite", name));
        for (std::size_t i = 0; i < target.vertices.size(); ++i) {
            if (target.vertices[i] >= animation_.rest.vertex_count() ||
                (i > 0 && target.vertices[i] <= target.vertices[i - 1]))
                fail(fmt::format("morph target {} moves vertex {} of {} out of turn", name, target.vertices[i],
                                 animation_.rest.vertex_count()));
            if (!target.offsets[i].allFinite())
                fail(fmt::format("morph target {} moves vertex {} by what is not finite", name, target.vertices[i]));
        }
    }

    const Animation& animation_;
    const Rig& rig_;
};

/// Takes the triangles of a mesh for the faces of its file.
void number_triangles(TriangleMesh& mesh) {
    mesh.source_face.clear();
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
}

void check_rest(Animation& animation) {
    TriangleMesh& rest = animation.rest;
    const auto fail = [&](const std::string& message) { throw MeshError(animation.name + ": " + message); };
    for (const Face& face : rest.faces)
        for (const std::uint32_t corner : face)
            if (corner >= rest.vertex_count()) fail(fmt::format("a face names vertex {}", corner));
    for (const std::uint32_t v : animation.vertex_of_source)
        if (v >= rest.vertex_count()) fail(fmt::format("a vertex of the file is welded to vertex {}", v));
    for (std::size_t v = 0; v < rest.vertex_count(); ++v)
        if (!rest.vertices[v].allFinite()) fail(fmt::format("vertex {} of the rest shape is not finite", v));
    const bool is_of_triangles = rest.source_face.empty();
    const std::size_t removed = remove_collapsed_faces(rest);
    if (rest.faces.empty()) fail("the surface has no faces");
    if (const std::string fault = size_fault(rest, k_drawable_sizes); !fault.empty()) fail(fault);
    if (removed == 0) return;
    animation.warnings.push_back(
        fmt::format("{} faces without area in any frame were left out (two of their corners "
                    "are one place)",
                    removed));
    if (is_of_triangles) number_triangles(rest);
}

/// Returns the vertices of the surface at rest, posed if it has a rig.
std::vector<Vec3> posed_at_rest(const Animation& animation) {
    std::vector<Vec3> vertices = animation.rest.vertices;
    if (!animation.rig.bones.empty())
        pose_vertices(animation.rig, animation.rest.vertices, rest_pose(animation.rig), vertices);
    return vertices;
}

/// Keeps one of the faces that lie on each other, and turns faces outward, by the shape at rest.
void prepare_faces(Animation& animation) {
    const bool is_of_triangles = animation.rest.source_face.empty();
    TriangleMesh shape = animation.rest;
    shape.vertices = posed_at_rest(animation);
    const std::size_t removed = merge_coincident_faces(shape);
    warn_of_coincident_faces(removed, animation.warnings);
    warn_of_turned_faces(orient_faces(shape), animation.warnings);
    shape.vertices = std::move(animation.rest.vertices);
    animation.rest = std::move(shape);
    if (removed > 0 && is_of_triangles) number_triangles(animation.rest);
}

void check_counts(const Animation& animation, const Clip& clip) {
    const auto fail = [&](const std::string& message) {
        throw MeshError(fmt::format("{}: clip {}: {}", animation.name, quote(clip.name), message));
    };
    const bool is_sequence = animation.kind == AnimationKind::sequence;
    if (clip.size() == 0) fail("there are no frames");
    if (!(clip.frames_per_second > 0) || !std::isfinite(clip.frames_per_second))
        fail(fmt::format("{} is no rate of frames", clip.frames_per_second));
    if (is_sequence ? !clip.poses.empty() : !clip.frames.empty())
        fail("a mesh sequence has vertex positions, a rig poses");
    for (std::size_t i = 0; i < clip.poses.size(); ++i)
        if (clip.poses[i].nodes.size() != animation.rig.nodes.size() ||
            clip.poses[i].weights.size() != animation.rig.targets.size())
            fail(fmt::format("frame {} has {} nodes and {} weights instead of {} and {}", i, clip.poses[i].nodes.size(),
                             clip.poses[i].weights.size(), animation.rig.nodes.size(), animation.rig.targets.size()));
    for (std::size_t i = 0; i < clip.frames.size(); ++i)
        if (clip.frames[i].size() != animation.rest.vertex_count())
            fail(fmt::format("frame {} has {} vertices instead of {}", i, clip.frames[i].size(),
                             animation.rest.vertex_count()));
}

/// Returns a list like "3, 4, 9 and 12 more".
std::string listed(const std::vector<std::size_t>& numbers) {
    constexpr std::size_t k_shown = 8;
    const std::vector<std::size_t> shown(
        numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(std::min(k_shown, numbers.size())));
    const std::string more =
        numbers.size() > k_shown ? fmt::format(" and {} more", numbers.size() - k_shown) : std::string();
    return fmt::format("{}{}", fmt::join(shown, ", "), more);
}

/// Removes the frames that are not finite from one of a clip's lists; returns their numbers.
template <typename Frame>
std::vector<std::size_t> drop_broken(std::vector<Frame>& frames) {
    std::vector<std::size_t> dropped;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!is_finite(frames[i])) {
            dropped.push_back(i);
            continue;
        }
        if (kept != i) frames[kept] = std::move(frames[i]);
        ++kept;
    }
    frames.resize(kept);
    return dropped;
}

void drop_broken_frames(Animation& animation, Clip& clip) {
    std::vector<std::size_t> dropped = drop_broken(clip.poses);
    std::ranges::copy(drop_broken(clip.frames), std::back_inserter(dropped));
    if (dropped.empty()) return;
    if (clip.size() == 0)
        throw MeshError(
            fmt::format("{}: clip {}: no frame is finite; export it again", animation.name, quote(clip.name)));
    animation.warnings.push_back(
        fmt::format("clip {}: frames {} are not finite and were dropped", quote(clip.name), listed(dropped)));
}

constexpr float k_rounding = 1e-6f;

bool same_pose(const Pose& a, const Pose& b) {
    const auto same_node = [](const NodeTransform& s, const NodeTransform& t) {
        return (s.translation - t.translation).norm() <= k_rounding * (1 + t.translation.norm()) &&
               (s.scale - t.scale).norm() <= k_rounding * (1 + t.scale.norm()) &&
               std::min((s.rotation.coeffs() - t.rotation.coeffs()).norm(),
                        (s.rotation.coeffs() + t.rotation.coeffs()).norm()) <= k_rounding;
    };
    const auto same_weight = [](float s, float t) { return std::abs(s - t) <= k_rounding; };
    return std::ranges::equal(a.nodes, b.nodes, same_node) && std::ranges::equal(a.weights, b.weights, same_weight);
}

bool moves(const Animation& animation, const Clip& clip) {
    const float size = static_cast<float>(bounding_box(animation.rest).diagonal());
    const auto same_frame = [&](const std::vector<Vec3>& frame) {
        return std::ranges::equal(frame, clip.frames.front(),
                                  [&](const Vec3& p, const Vec3& q) { return (p - q).norm() <= k_rounding * size; });
    };
    return std::ranges::any_of(clip.poses, [&](const Pose& pose) { return !same_pose(pose, clip.poses.front()); }) ||
           std::ranges::any_of(clip.frames, [&](const std::vector<Vec3>& frame) { return !same_frame(frame); });
}

/// Returns whether a face is a point or its height is tiny compared with its longest edge.
std::vector<std::uint32_t> faces_without_area(const std::vector<Face>& faces, const std::vector<Vec3>& vertices) {
    constexpr double k_flat = 1e-6;
    std::vector<std::uint32_t> found;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const Vec3d a = vertices[faces[f][0]].cast<double>(), b = vertices[faces[f][1]].cast<double>(),
                    c = vertices[faces[f][2]].cast<double>();
        const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        if (!((b - a).cross(c - a).norm() > k_flat * longest)) found.push_back(f);
    }
    return found;
}

/// Returns up to 64 frames, spread evenly over all clips; the rest shape if there are none.
std::vector<std::vector<Vec3>> some_frames(const Animation& animation) {
    constexpr std::size_t k_looked_at = 64;
    std::vector<std::pair<const Clip*, std::size_t>> all;
    for (const Clip& clip : animation.clips)
        for (std::size_t i = 0; i < clip.size(); ++i) all.emplace_back(&clip, i);
    const auto chosen = evenly_spaced(all, k_looked_at);
    std::vector<std::vector<Vec3>> frames(chosen.size());
    parallel_for(frames.size(), [&](std::size_t i) {
        const auto& [clip, frame] = chosen[i];
        frames[i] = frame_vertices(animation, *clip, frame);
    });
    if (!frames.empty()) return frames;
    frames.push_back(posed_at_rest(animation));
    return frames;
}

void warn_of_collapsed_faces(Animation& animation) {
    const std::vector<std::vector<Vec3>> frames = some_frames(animation);
    std::vector<std::vector<std::uint32_t>> collapsed(frames.size());
    parallel_for(frames.size(),
                 [&](std::size_t i) { collapsed[i] = faces_without_area(animation.rest.faces, frames[i]); });
    std::vector<std::size_t> times(animation.rest.face_count(), 0);
    for (const std::vector<std::uint32_t>& faces : collapsed)
        for (const std::uint32_t f : faces) ++times[f];
    const auto most = std::ranges::count_if(times, [&](std::size_t n) { return 2 * n > frames.size(); });
    if (most) animation.warnings.push_back(fmt::format("{} faces have no area in most frames", most));
}

}  // namespace

bool is_finite(const Pose& pose) {
    return std::ranges::all_of(pose.nodes, RigCheck::is_finite) &&
           std::ranges::all_of(pose.weights, [](float weight) { return std::isfinite(weight); });
}

bool is_finite(const std::vector<Vec3>& frame) {
    return std::ranges::all_of(frame, [](const Vec3& p) { return p.allFinite(); });
}

void check_animation(Animation& animation) {
    check_rest(animation);
    RigCheck(animation).check();
    if (animation.kind != AnimationKind::sequence) {
        if (animation.rig.influence_begin.size() != animation.rest.vertex_count() + 1)
            throw MeshError(animation.name + ": the rig is of another number of vertices");
        if (animation.rig.bones.empty()) throw MeshError(animation.name + ": the rig has no bones");
        clean_influences(animation.rig, animation.name, animation.warnings);
    }
    prepare_faces(animation);
    for (Clip& clip : animation.clips) {
        check_counts(animation, clip);
        drop_broken_frames(animation, clip);
        if (clip.size() > 1 && !moves(animation, clip))
            animation.warnings.push_back(fmt::format("clip {} never moves", quote(clip.name)));
    }
    warn_of_collapsed_faces(animation);
}

}  // namespace exemplar
