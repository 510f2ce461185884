#include "host/lines/extraction/lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <span>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A mesh with the curvature that calculus gives it, so that lines are tested apart from estimates.
struct Surface {
    TriangleMesh mesh;
    std::vector<Vec3> normals;
    VertexCurvature curvature;

    operator LineSurface() const { return {mesh.faces, mesh.vertices, normals, curvature}; }
    /// Adds what is known at the next vertex; e2 follows.
    void add(const Vec3& normal, double k1, double k2, const Vec3& e1, const std::array<double, 4>& derivative) {
        normals.push_back(normal);
        curvature.k1.push_back(static_cast<float>(k1));
        curvature.k2.push_back(static_cast<float>(k2));
        curvature.e1.push_back(e1);
        curvature.e2.push_back(normal.cross(e1));
        std::array<float, 4> rounded;
        for (std::size_t k = 0; k < 4; ++k) rounded[k] = static_cast<float>(derivative[k]);
        curvature.derivative.push_back(rounded);
    }
};

constexpr double k_ring = 3;  // radius of the torus' circle; its tube has radius 1

Surface torus(std::uint32_t n) {
    Surface surface{shapes::torus(k_ring, 1, 3 * n, n), {}, {}};
    for (const Vec3& p : surface.mesh.vertices) {
        const double w = std::hypot(p.x(), p.y()), cosine = w - k_ring, sine = p.z();
        const double x = p.x() / w, y = p.y() / w;
        surface.add(shapes::detail::vec3(cosine * x, cosine * y, sine), 1, cosine / w,
                    shapes::detail::vec3(-sine * x, -sine * y, cosine), {0, 0, -k_ring * sine / (w * w), 0});
    }
    return surface;
}

/// An elliptic cylinder along z with semi-axes 2 (x) and 1 (y). The middles of quads, not vertices, lie on the axes.
Surface elliptic_cylinder(std::uint32_t n, bool inside_out) {
    Surface surface{shapes::cylinder(1, 3, n, 10, false), {}, {}};
    for (Vec3& p : surface.mesh.vertices) {
        const double t = std::atan2(p.y(), p.x()) + std::numbers::pi / n, s = std::sin(t), c = std::cos(t);
        p = shapes::detail::vec3(2 * c, s, p.z());
        const double speed = std::sqrt(4 * s * s + c * c), k = 2 / std::pow(speed, 3);
        const double slope = -6 * std::pow(speed, -4) * 3 * s * c / speed / speed;  // dk/dt over speed
        const Vec3 tangent = shapes::detail::vec3(-2 * s / speed, c / speed, 0);
        const Vec3 normal = shapes::detail::vec3(c / speed, 2 * s / speed, 0);
        if (!inside_out) {
            surface.add(normal, k, 0, tangent, {slope, 0, 0, 0});
            continue;
        }
        // All curvatures change their sign, so the order changes; the tangent becomes e2 = n x e1 for e1 = -z.
        surface.add(-normal, 0, -k, {0, 0, -1}, {0, 0, 0, -slope * (-normal).cross(Vec3(0, 0, -1)).dot(tangent)});
    }
    if (inside_out)
        for (Face& face : surface.mesh.faces) std::swap(face[0], face[1]);
    return surface;
}

LineOptions seen_from(const Vec3& eye, float feature_size) {
    LineOptions options;
    options.eye = eye;
    options.feature_size = feature_size;
    return options;
}
std::size_t count(const std::vector<std::uint8_t>& flags) {
    return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1));
}
/// Whether `holds` says the same of all three corners, and what; else nothing.
std::optional<bool> at_all(const Face& face, const std::function<bool(std::uint32_t)>& holds) {
    const bool first = holds(face[0]);
    for (const std::uint32_t v : face)
        if (holds(v) != first) return std::nullopt;
    return first;
}

TEST(Contours, AreWhereTheSurfaceTurnsAway) {
    const Surface surface = torus(40);
    for (const Vec3& eye : {Vec3(9, 2, 4), Vec3(0.3f, -12, 1), Vec3(0.1f, 0.2f, 8)}) {
        const auto flags = classify_faces(surface, LineType::contours, seen_from(eye, 0.1f));
        EXPECT_GT(count(flags), 100);
        for (std::size_t f = 0; f < flags.size(); ++f) {
            const auto front = at_all(surface.mesh.faces[f], [&](std::uint32_t v) {
                return (eye - surface.mesh.vertices[v]).dot(surface.normals[v]) > 0;
            });
            EXPECT_EQ(flags[f] == 0, front.has_value()) << f;
        }
    }
}

/// The nearest point of the torus.
Vec3d on_torus(const Vec3d& p) {
    const Vec3d ring = Vec3d(p.x(), p.y(), 0).normalized() * k_ring;
    return ring + (p - ring).normalized();
}
Vec3d torus_normal(const Vec3d& p) {
    return p - Vec3d(p.x(), p.y(), 0).normalized() * k_ring;
}
/// The unit projection of the view vector into the torus.
Vec3d toward(const Vec3d& p, const Vec3d& eye) {
    const Vec3d n = torus_normal(p), w = eye - p;
    return (w - w.dot(n) * n).normalized();
}
double radial_curvature(const Vec3d& p, const Vec3d& eye) {
    const double w = std::hypot(p.x(), p.y());
    const double along_ring = toward(p, eye).dot(Vec3d(-p.y(), p.x(), 0) / w);
    return 1 - along_ring * along_ring * (1 - (w - k_ring) / w);
}
/// Its derivative towards the eye, by a central difference on the surface.
double radial_slope(const Vec3d& p, const Vec3d& eye) {
    constexpr double k_step = 1e-4;
    const Vec3d step = k_step * toward(p, eye);
    return (radial_curvature(on_torus(p + step), eye) - radial_curvature(on_torus(p - step), eye)) / (2 * k_step);
}

TEST(SuggestiveContours, AreWhereCalculusSays) {
    const Surface surface = torus(96);
    constexpr float k_size = 0.2f;
    struct Case {
        LineType type;
        double sign, threshold;
    };
    std::size_t found = 0, unclear = 0;
    for (const Vec3& eye : {Vec3(9, 2, 3), Vec3(1, -12, 2), Vec3(2, 1, 8)})
        for (const Case& c :
             {Case{LineType::suggestive_contours, 1, 0.01}, Case{LineType::suggestive_highlights, -1, 0.02}}) {
            const auto flags = classify_faces(surface, c.type, seen_from(eye, k_size));
            const Vec3d far = eye.cast<double>();
            // By how much the test is passed, against the threshold itself.
            const auto passes = [&](std::uint32_t v, double slack) {
                const Vec3d p = surface.mesh.vertices[v].cast<double>(), w = (far - p).normalized();
                const double cosine = torus_normal(p).dot(w), sine = std::sqrt(1 - cosine * cosine);
                if (cosine < slack * 0.2) return false;
                return c.sign * radial_slope(p, far) * sine / cosine * k_size * k_size > c.threshold * (1 + slack);
            };
            for (std::size_t f = 0; f < flags.size(); ++f) {
                const Face& face = surface.mesh.faces[f];
                const auto side = at_all(face, [&](std::uint32_t v) {
                    return radial_curvature(surface.mesh.vertices[v].cast<double>(), far) > 0;
                });
                const auto certain = at_all(face, [&](std::uint32_t v) { return passes(v, 0.05); });
                const auto possible = at_all(face, [&](std::uint32_t v) { return passes(v, -0.05); });
                if (side || possible == false) {
                    EXPECT_EQ(flags[f], 0) << f;
                } else if (certain == true) {
                    EXPECT_EQ(flags[f], 1) << f;
                    ++found;
                } else {
                    ++unclear;
                }
            }
        }
    EXPECT_GT(found, 300);
    EXPECT_LT(unclear, found);
}

TEST(SuggestiveContours, AreMinimaOfTheShading) {
    // The definition that needs no curvature: n.w is least, along w, where a suggestive contour is; a highlight is
    // where it is greatest.
    const Surface surface = torus(96);
    const Vec3 eye(9, 2, 5);
    const Vec3d far = eye.cast<double>();
    const auto shading = [&](const Vec3d& p) { return torus_normal(p).dot((far - p).normalized()); };
    for (const LineType type : {LineType::suggestive_contours, LineType::suggestive_highlights}) {
        const auto segments = extract_lines(surface, type, seen_from(eye, 0.2f));
        EXPECT_GT(segments.size(), 30);
        for (const LineSegment& segment : segments) {
            Vec3d p = Vec3d::Zero();
            for (std::size_t i = 0; i < 3; ++i)
                p += double(segment.ends[0][i] + segment.ends[1][i]) / 2 *
                     surface.mesh.vertices[surface.mesh.faces[segment.face][i]].cast<double>();
            p = on_torus(p);
            constexpr double k_step = 0.15;
            const Vec3d step = k_step * toward(p, far);
            const double here = shading(p), before = shading(on_torus(p - step)), after = shading(on_torus(p + step));
            const double bend = before + after - 2 * here;
            EXPECT_GT(type == LineType::suggestive_contours ? bend : -bend, 0);
        }
    }
}

TEST(Ridges, OfAnEllipticCylinderRunAlongItsSharpSides) {
    constexpr std::uint32_t k_around = 30;
    for (const bool inside_out : {false, true}) {
        const Surface surface = elliptic_cylinder(k_around, inside_out);
        const LineOptions options = seen_from({0, 0, 0}, 0.1f);  // curvature 2 there: 0.2, twice the threshold
        const LineType sharp = inside_out ? LineType::valleys : LineType::ridges;
        const LineType none = inside_out ? LineType::ridges : LineType::valleys;
        const auto flags = classify_faces(surface, sharp, options);
        EXPECT_EQ(count(classify_faces(surface, none, options)), 0);
        for (std::size_t f = 0; f < flags.size(); ++f) {
            std::set<bool> sides;
            for (const std::uint32_t v : surface.mesh.faces[f]) sides.insert(surface.mesh.vertices[v].y() > 0);
            EXPECT_EQ(flags[f], sides.size() == 2 ? 1 : 0) << f;
        }
        LineOptions stricter = options;
        stricter.thresholds.ridges_valleys = 0.21f;
        EXPECT_EQ(count(classify_faces(surface, sharp, stricter)), 0);
    }
}

TEST(Ridges, CanBeCutOffWhereTheSurfaceTurnsAway) {
    const Surface surface = elliptic_cylinder(30, false);
    LineOptions options = seen_from({20, 0, 0}, 0.1f);
    const std::size_t all = count(classify_faces(surface, LineType::ridges, options));
    options.front_facing_only = true;
    EXPECT_EQ(2 * count(classify_faces(surface, LineType::ridges, options)), all);
}

TEST(PrincipalHighlights, OfACylinderFaceTheEye) {
    Surface surface{shapes::cylinder(1, 3, 30, 10, false), {}, {}};
    for (Vec3& p : surface.mesh.vertices) {
        const double t = std::atan2(p.y(), p.x()) + std::numbers::pi / 30;
        p = shapes::detail::vec3(std::cos(t), std::sin(t), p.z());
        surface.add({p.x(), p.y(), 0}, 1, 0, {-p.y(), p.x(), 0}, {});
    }
    // Curvature 1 and cosine 1: the strength is the squared feature size.
    const auto at = [&](float size) {
        return classify_faces(surface, LineType::principal_highlights, seen_from({1e3f, 0, 0}, size));
    };
    EXPECT_EQ(count(at(0.19f)), 0);
    const auto flags = at(0.21f);
    for (std::size_t f = 0; f < flags.size(); ++f) {
        const auto side =
            at_all(surface.mesh.faces[f], [&](std::uint32_t v) { return surface.mesh.vertices[v].y() > 0; });
        const bool front = surface.mesh.vertices[surface.mesh.faces[f][0]].x() > 0;
        EXPECT_EQ(flags[f], !side && front ? 1 : 0) << f;
    }
}

TEST(ApparentRidges, SeenHeadOnAreRidgesAndValleys) {
    // Shallow waves with crests and troughs along lines of constant x + y / 2, from straight above.
    TriangleMesh mesh = shapes::transformed(shapes::grid(60, 60, 8), [](const Vec3& p) {
        return shapes::detail::vec3(p.x(), p.y(), 0.01 * std::cos(1.5 * double(p.x()) + 0.75 * double(p.y()) + 0.02));
    });
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    const VertexCurvature& curvature = estimator.estimate(mesh.vertices);
    const LineSurface surface{mesh.faces, mesh.vertices, estimator.normals(), curvature};
    LineOptions options = seen_from({4, 4, 1e4f}, 1);
    options.thresholds.ridges_valleys = 0.02f;
    options.thresholds.apparent_ridges = 0.02f * 0.02f;  // of a squared curvature
    const auto apparent = classify_faces(surface, LineType::apparent_ridges, options);
    const auto ridges = classify_faces(surface, LineType::ridges, options);
    const auto valleys = classify_faces(surface, LineType::valleys, options);
    std::size_t compared = 0, same = 0, lines = 0;
    for (std::size_t f = 0; f < apparent.size(); ++f) {
        const Vec3& p = mesh.vertices[mesh.faces[f][0]];
        if (std::min({p.x(), p.y(), 8 - p.x(), 8 - p.y()}) < 0.7f) continue;
        ++compared;
        same += apparent[f] == (ridges[f] | valleys[f]) ? 1u : 0u;
        lines += apparent[f];
    }
    EXPECT_GT(lines, 250);
    // Where a line passes through a vertex, rounding decides on which side it does.
    EXPECT_GT(same, compared - compared / 100);
}

TEST(ApparentRidges, OfASphereHugItsContour) {
    // Foreshortening makes the view-dependent curvature of a sphere grow to its contour, and only there has it a
    // maximum.
    const TriangleMesh mesh = shapes::icosphere(5, 1);
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    const VertexCurvature& curvature = estimator.estimate(mesh.vertices);
    const LineSurface surface{mesh.faces, mesh.vertices, estimator.normals(), curvature};
    const Vec3 eye(30, 17, 25);
    LineOptions options = seen_from(eye, 0.05f);
    const auto flags = classify_faces(surface, LineType::apparent_ridges, options);
    EXPECT_GT(count(flags), 50);
    for (std::size_t f = 0; f < flags.size(); ++f)
        if (flags[f]) {
            EXPECT_LT(mesh.vertices[mesh.faces[f][0]].dot(eye.normalized()), 0.15f) << f;
        }
}

/// A lumpy sphere with estimated curvature, which has all types of lines.
Surface lumpy() {
    Surface surface;
    surface.mesh = shapes::transformed(shapes::icosphere(5, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.2f * std::sin(3 * p.x() + 1) + 0.15f * p.y() * std::cos(4 * p.z()));
    });
    CurvatureEstimator estimator(surface.mesh.faces, surface.mesh.vertex_count());
    surface.curvature = estimator.estimate(surface.mesh.vertices, {true, 1});
    surface.normals = estimator.normals();
    return surface;
}
const Vec3 k_eye(3, 2, 4);
constexpr float k_lumpy_size = 0.18f;

class EveryLine : public testing::TestWithParam<LineType> {};

TEST_P(EveryLine, IsFoundAndThin) {
    const Surface surface = lumpy();
    const std::size_t faces = count(classify_faces(surface, GetParam(), seen_from(k_eye, k_lumpy_size)));
    EXPECT_GT(faces, 20);
    EXPECT_LT(faces, surface.mesh.face_count() / 15);
}

TEST_P(EveryLine, DoesNotDependOnTheSignsOfDirections) {
    for (Surface surface : {lumpy(), torus(60), elliptic_cylinder(40, false)}) {
        const LineOptions options = seen_from(k_eye, 0.15f);
        const auto before = classify_faces(surface, GetParam(), options);
        Random random(7);
        for (std::size_t i = 0; i < surface.normals.size(); ++i) {
            if (random.index(2) == 0) continue;
            surface.curvature.e1[i] = -surface.curvature.e1[i];
            surface.curvature.e2[i] = -surface.curvature.e2[i];
            for (float& d : surface.curvature.derivative[i]) d = -d;
        }
        EXPECT_EQ(classify_faces(surface, GetParam(), options), before);
    }
}

TEST_P(EveryLine, ScalesWithMeshAndView) {
    Surface surface = lumpy();
    const auto before = classify_faces(surface, GetParam(), seen_from(k_eye, k_lumpy_size));
    constexpr float k_scale = 1024;  // exact in floating point
    for (Vec3& p : surface.mesh.vertices) p *= k_scale;
    for (std::size_t i = 0; i < surface.normals.size(); ++i) {
        surface.curvature.k1[i] /= k_scale;
        surface.curvature.k2[i] /= k_scale;
        for (float& d : surface.curvature.derivative[i]) d /= k_scale * k_scale;
    }
    EXPECT_EQ(classify_faces(surface, GetParam(), seen_from(k_scale * k_eye, k_scale * k_lumpy_size)), before);
}

TEST_P(EveryLine, MovesWithRigidMotions) {
    Surface surface = lumpy();
    const auto before = classify_faces(surface, GetParam(), seen_from(k_eye, k_lumpy_size));
    const Eigen::Matrix3f rotation = shapes::random_rotation(5);
    const Vec3 offset(0.5f, -1, 2);
    for (Vec3& p : surface.mesh.vertices) p = rotation * p + offset;
    for (auto* vectors : {&surface.normals, &surface.curvature.e1, &surface.curvature.e2})
        for (Vec3& v : *vectors) v = rotation * v;
    const auto after = classify_faces(surface, GetParam(), seen_from(rotation * k_eye + offset, k_lumpy_size));
    std::size_t different = 0;
    for (std::size_t f = 0; f < before.size(); ++f) different += before[f] != after[f] ? 1u : 0u;
    EXPECT_LE(different, before.size() / 2000);  // the rounding of a zero beside a vertex
}

TEST_P(EveryLine, HasSegmentsWithinTheFacesThatCarryIt) {
    const Surface surface = lumpy();
    const LineOptions options = seen_from(k_eye, k_lumpy_size);
    std::vector<std::uint8_t> carries(surface.mesh.face_count(), 0);
    std::uint32_t last = 0;
    for (const LineSegment& segment : extract_lines(surface, GetParam(), options)) {
        EXPECT_GE(segment.face, last);
        last = segment.face;
        carries[segment.face] = 1;
        for (const auto& end : segment.ends) {
            EXPECT_NEAR(end[0] + end[1] + end[2], 1, 1e-5);
            for (float b : end) EXPECT_GE(b, -1e-6);
        }
        EXPECT_NE(segment.ends[0], segment.ends[1]);
        for (float strength : segment.strength) EXPECT_GT(strength, 0);
    }
    EXPECT_EQ(carries, classify_faces(surface, GetParam(), options));
}

TEST_P(EveryLine, DoesNotDependOnThreads) {
    const Surface surface = lumpy();
    const LineOptions options = seen_from(k_eye, k_lumpy_size);
    const auto many = classify_faces(surface, GetParam(), options);
    const ThreadLimit limit(1);
    EXPECT_EQ(classify_faces(surface, GetParam(), options), many);
}

TEST_P(EveryLine, FacesTheEyeUnlessItIsAContourOrFixed) {
    const LineType type = GetParam();
    if (!depends_on_view(type) || type == LineType::contours) return;
    const Surface surface = lumpy();
    const auto flags = classify_faces(surface, type, seen_from(k_eye, k_lumpy_size));
    for (std::size_t f = 0; f < flags.size(); ++f)
        if (flags[f]) {
            const auto front = at_all(surface.mesh.faces[f], [&](std::uint32_t v) {
                return (k_eye - surface.mesh.vertices[v]).dot(surface.normals[v]) > 0;
            });
            EXPECT_NE(front, false) << f;
        }
}

TEST_P(EveryLine, KeepsItsName) {
    EXPECT_EQ(line_type_named(name_of(GetParam())), GetParam());
}

TEST_P(EveryLine, RefusesWhatDoesNotFit) {
    Surface surface = torus(10);
    const LineType type = GetParam();
    const LineOptions options = seen_from(k_eye, 0.1f);
    surface.normals.pop_back();
    EXPECT_THROW(classify_faces(surface, type, options), UsageError);
    surface = torus(10);
    surface.curvature.derivative.clear();
    if (type == LineType::contours) {
        EXPECT_NO_THROW(classify_faces(surface, type, options));
        return;
    }
    EXPECT_THROW(classify_faces(surface, type, options), UsageError);
    surface = torus(10);
    for (float size : {0.0f, -1.0f, HUGE_VALF, std::nanf("")})
        EXPECT_THROW(extract_lines(surface, type, seen_from(k_eye, size)), UsageError);
}

// Of the other two, which are edges of the mesh, all this is plain.
INSTANTIATE_TEST_SUITE_P(AllTypes, EveryLine, testing::ValuesIn(std::span(k_line_types).first(7)),
                         [](const auto& type) { return std::string(name_of(type.param)); });

TEST(LineTypes, AreMeantByTheirBeginnings) {
    EXPECT_EQ(line_type_from_prefix("Suggestive"), LineType::suggestive_contours);
    EXPECT_EQ(line_type_from_prefix("apparent-ridges"), LineType::apparent_ridges);
    EXPECT_EQ(line_type_from_prefix("highlights"), LineType::suggestive_highlights);
    for (const LineType type : k_line_types) EXPECT_EQ(line_type_from_prefix(name_of(type)), type);
    for (const char* other : {"", "co", "contourss", "none"}) EXPECT_EQ(line_type_from_prefix(other), std::nullopt);
}

TEST(LineTypes, KnowNoOtherName) {
    EXPECT_EQ(line_type_named("contour"), std::nullopt);
    EXPECT_EQ(line_type_named(""), std::nullopt);
}

/// 20 times the feature size of points without curvature is the radius of the sphere around them.
float radius_around(const std::vector<Vec3>& points) {
    VertexCurvature flat;
    flat.k1.resize(points.size());
    flat.k2.resize(points.size());
    return 20 * feature_size(points, flat);
}

TEST(FeatureSize, WithoutCurvatureIsThatOfTheSmallestSphere) {
    EXPECT_EQ(radius_around({}), 0);
    EXPECT_EQ(radius_around({{1, 2, 3}}), 0);
    EXPECT_NEAR(radius_around({{1, 2, 3}, {1, 2, 7}, {1, 2, 7}}), 2, 1e-5);
    EXPECT_NEAR(radius_around({{-3, 0, 0}, {3, 0, 0}, {0.5f, 1, 0}, {0, 0, 2}}), 3, 1e-5);  // two points hold it
    EXPECT_NEAR(radius_around({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}), 1.7320508, 1e-5);  // four do
    EXPECT_NEAR(radius_around(shapes::box(2, 3, 6, 4).vertices), 3.5, 1e-5);  // eight on a sphere
    EXPECT_NEAR(radius_around(shapes::icosphere(4, 2).vertices), 2, 1e-4);
    EXPECT_NEAR(radius_around(shapes::grid(7, 7, 2).vertices), std::sqrt(2.0), 1e-5);
}

TEST(FeatureSize, IsAHundredthOfTheRadiusOfItsFlatTenth) {
    const TriangleMesh mesh = shapes::icosphere(3, 2);
    VertexCurvature curvature = estimate_curvature(mesh, false);
    EXPECT_NEAR(feature_size(mesh.vertices, curvature), 0.01 * 2, 1e-5);
    // Of all curvatures together: more than a tenth is k2 of a fourth of the vertices.
    for (std::size_t i = 0; i < curvature.k2.size() / 4; ++i) curvature.k2[i] = -0.25f;
    EXPECT_NEAR(feature_size(mesh.vertices, curvature), 0.01 * 4, 1e-5);
    EXPECT_THROW(feature_size(std::span(mesh.vertices).first(3), curvature), UsageError);
}

}  // namespace
}  // namespace exemplar
