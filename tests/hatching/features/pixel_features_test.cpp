#include "host/hatching/features/pixel_features.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "tests/hatching/features/host_tools.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr int k_view_width = 240, k_view_height = 200;

/// Seen without perspective, so that analytic truths are simple.
HatchingView parallel_view(const TriangleMesh& mesh, const Vec3& direction) {
    return {fit_camera(mesh, direction, 1.2f, {.vertical_fov = 0}), Vec3(1, 2, 2) / 3, k_view_width, k_view_height};
}

Vec2 center_of(std::uint32_t pixel) {
    const std::uint32_t row = pixel / k_view_width;
    return {static_cast<float>(pixel % k_view_width) + 0.5f, static_cast<float>(row) + 0.5f};
}

std::uint32_t number_of(const std::string& name) {
    const auto& names = pixel_feature_names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) ADD_FAILURE() << "no feature is called " << name;
    return static_cast<std::uint32_t>(found - names.begin());
}

std::size_t field_of_view(const std::string& name) {
    const auto& names = orientation_feature_names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) ADD_FAILURE() << "no field is called " << name;
    return static_cast<std::size_t>(found - names.begin());
}

std::vector<std::uint32_t> all_features() {
    std::vector<std::uint32_t> all(k_pixel_features);
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

const HatchingSurface& ball() {
    static const HatchingSurface surface = measure_surface(shapes::icosphere(3, 2));
    return surface;
}

/// A ring without symmetry, as points that are equally far from others may be told apart by rounding.
TriangleMesh uneven_ring() {
    return shapes::transformed(shapes::torus(2, 0.7F, 36, 18), [](const Vec3& p) {
        return Vec3(p.x() * (1 + 0.1f * p.z()) + 0.1f * p.y(), p.y() * (1 + 0.07f * p.x()), 1.1f * p.z());
    });
}

const HatchingSurface& ring() {
    static const HatchingSurface surface = measure_surface(uneven_ring());
    return surface;
}

TEST(PixelFeatures, HaveNamesOfTheirOwn) {
    const auto& scalars = pixel_feature_names();
    EXPECT_EQ(scalars.size(), k_pixel_features);
    EXPECT_EQ(std::set<std::string>(scalars.begin(), scalars.end()).size(), k_pixel_features);
    const auto& fields = orientation_feature_names();
    EXPECT_EQ(fields.size(), k_orientation_features);
    EXPECT_EQ(std::set<std::string>(fields.begin(), fields.end()).size(), k_orientation_features);
}

/// A picture of twice the size shows the same, so its features are the same where its pixels lie.
TEST(PixelFeatures, DoNotDependOnTheSizeOfThePicture) {
    HostTools host;
    const HatchingView small = parallel_view(ring().mesh, Vec3(1, 2, 3));
    HatchingView large = small;
    large.width *= 2;
    large.height *= 2;
    EXPECT_NEAR(size_in_view(ring(), large), 2 * size_in_view(ring(), small), 1e-3f);
    PixelFeatures of_small(ring(), small, host.tools), of_large(ring(), large, host.tools);
    of_large.set_scale(2);
    std::vector<std::uint32_t> which;
    for (const char* name : {"image.I@5", "image.|grad V.N|@3", "image.curvature_max L.N@5", "lines.contours>0.001@10"})
        which.push_back(number_of(name));
    const FeatureMatrix found = of_large.scalars(which, {}), expected = of_small.scalars(which, {});
    for (std::size_t k = 0; k < which.size(); ++k) {
        std::vector<float> differences, sizes;
        for (std::size_t i = 0; i < of_small.size(); ++i) {
            const std::uint32_t pixel = of_small.pixels().pixel[i];
            const std::uint32_t x = pixel % k_view_width, y = pixel / k_view_width;
            const std::int32_t row = of_large.pixels().row[2 * y * 2 * k_view_width + 2 * x];
            if (row < 0) continue;
            differences.push_back(std::abs(found.column(k)[static_cast<std::size_t>(row)] - expected.column(k)[i]));
            sizes.push_back(std::abs(expected.column(k)[i]));
        }
        ASSERT_GT(differences.size(), 1000U);
        EXPECT_LT(upper_median(differences), 0.05f * upper_median(sizes)) << found.names[k];
    }
    // Unscaled, they are those of a picture with twice the details.
    of_large.set_scale(1);
    const FeatureMatrix other = of_large.scalars(which, {});
    EXPECT_NE(other.values, found.values);
}

/// Slices of a ball that is seen from the front are level if y is up, and upright if x is.
TEST(PixelFeatures, FieldsThatArtistsUseEverywhere) {
    HostTools host;
    HatchingView view = parallel_view(ball().mesh, Vec3::UnitZ());
    const auto means = [&](const std::string& name) {
        PixelFeatures features(ball(), view, host.tools);
        const OrientationFields fields = features.orientations({});
        DoubledAngle sum{};
        for (std::size_t i = 0; i < fields.rows; ++i) {
            const DoubledAngle v = fields.feature(field_of_view(name), i);
            sum = {sum[0] + v[0] / static_cast<float>(fields.rows), sum[1] + v[1] / static_cast<float>(fields.rows)};
        }
        return sum;
    };
    const auto expect_direction = [&](const std::string& name, const DoubledAngle& direction) {
        EXPECT_LT(squared_distance(means(name), direction), 0.001f) << name;
    };
    expect_direction("UxN", {1, 0});
    expect_direction("perp UxN", {-1, 0});
    view.up = Vec3::UnitX();
    expect_direction("UxN", {-1, 0});
    expect_direction("x", {1, 0});
    expect_direction("perp x", {-1, 0});
    expect_direction("diagonal", {0, 1});
    expect_direction("perp diagonal", {0, -1});
}

/// The same object, seen by eyes at other distances and without perspective.
TEST(HatchingView, TellsTheSizeOfAnObject) {
    const auto seen = [&](float distance, float fov) {
        HatchingView view;
        view.width = 300;
        view.height = 200;
        view.camera.view = look_at(Vec3(0, 0, distance), Vec3(0, 0, -1));
        view.camera.projection = fov > 0 ? perspective(fov, 1.5f, 0.1f, 100) : orthographic(4, 1.5f, 0.1f, 100);
        return size_in_view(ball(), view) / ball().unit;
    };
    EXPECT_NEAR(seen(10, 1), 100 / (10 * std::tan(0.5f)), 0.01f);
    EXPECT_NEAR(seen(20, 1), 100 / (20 * std::tan(0.5f)), 0.01f);
    EXPECT_NEAR(seen(10, 0), 25, 0.01f);
    EXPECT_NEAR(seen(20, 0), 25, 0.01f);
    EXPECT_GT(seen(0, 1), 0);  // from its middle
}

/// What is known of a pixel that shows a ball of radius 2 around the origin.
TEST(PixelFeatures, OfABallAreThoseOfABall) {
    HostTools host;
    const HatchingView view = parallel_view(ball().mesh, Vec3::UnitZ());
    PixelFeatures features(ball(), view, host.tools);
    const std::vector<std::string> names{"curvature.mean@0.05", "image.V.N@1", "image.L.N@1", "image.depth"};
    std::vector<std::uint32_t> which;
    std::ranges::transform(names, std::back_inserter(which), number_of);
    const FeatureMatrix found = features.scalars(which, {});
    EXPECT_EQ(found.names, names);
    const Eigen::Matrix4f to_view = view.camera.view;
    const float scale = to_view.block<3, 3>(0, 0).determinant();
    EXPECT_NEAR(scale, 1, 1e-5f);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
        const std::uint32_t pixel = features.pixels().pixel[i];
        const Vec2 at = center_of(pixel);
        const float half = 0.5f * k_view_height / 2.1f;  // pixels of a unit, with a margin of a twentieth
        const Vec3 normal(0.5f * (at.x() - 0.5f * k_view_width) / half, -0.5f * (at.y() - 0.5f * k_view_height) / half,
                          0);
        const float off = normal.norm();
        // Near the border pictures are blurred with less than a Gaussian around.
        if (off > 0.85f) continue;
        ++inside;
        const float up = std::sqrt(1 - off * off);
        const Vec3 n(normal.x(), normal.y(), up);
        EXPECT_NEAR(found.column(0)[i], 0.5f * ball().unit, 0.03f * ball().unit);
        EXPECT_NEAR(found.column(1)[i], n.z(), 0.02f);
        EXPECT_NEAR(found.column(2)[i], std::max(n.dot(view.light), 0.0f), 0.03f);
        // From the middle, in units of half the diagonal of the box; what is nearer is less.
        EXPECT_NEAR(found.column(3)[i], -up / std::sqrt(3.0f), 0.02f);
    }
    EXPECT_GT(inside, 10000u);
}

TEST(PixelFeatures, DirectionsOnABallRunOutwardsAndAround) {
    HostTools host;
    const HatchingView view = parallel_view(ball().mesh, Vec3::UnitZ());
    PixelFeatures features(ball(), view, host.tools);
    OrientationFields fields = features.orientations({});
    std::size_t inside = 0;
    for (std::size_t i = 0; i < features.size(); ++i) {
        const std::uint32_t pixel = features.pixels().pixel[i];
        const Vec2 way = center_of(pixel) - 0.5f * Vec2(k_view_width, k_view_height);
        const float off = way.norm();
        if (off < 20 || off > 75) continue;
        ++inside;
        const DoubledAngle outwards = doubled_angle(std::atan2(way.y(), way.x()));
        EXPECT_LT(squared_distance(fields.field(field_of_view("grad V.N,3"))[i], outwards), 0.1f);
        EXPECT_LT(squared_distance(fields.field(field_of_view("VxN"))[i], -1.0f * outwards), 0.1f);
    }
    EXPECT_GT(inside, 10000u);
}

TEST(PixelFeatures, OfSomePixelsAreThoseOfAll) {
    HostTools host;
    const HatchingView view = parallel_view(ring().mesh, Vec3(1, 2, 3));
    PixelFeatures features(ring(), view, host.tools), again(ring(), view, host.tools);
    const FeatureMatrix all = features.scalars(all_features(), {});
    OrientationFields fields = features.orientations({});
    const auto last = static_cast<std::uint32_t>(features.size() - 1);
    const std::vector<std::uint32_t> rows{last, 5, 1000, 5, 0};
    // In another order, from here and there, one twice; the first time that anything is asked for.
    const std::vector<std::uint32_t> which{300, 2, 95, 240, 1, 100, 240};
    const FeatureMatrix some = again.scalars(which, rows);
    ASSERT_EQ(some.rows, rows.size());
    for (std::size_t k = 0; k < which.size(); ++k)
        for (std::size_t i = 0; i < rows.size(); ++i)
            EXPECT_EQ(some.column(k)[i], all.column(which[k])[rows[i]]) << some.names[k];
    OrientationFields few = again.orientations(rows);
    for (std::size_t k = 0; k < k_orientation_fields; ++k)
        for (std::size_t i = 0; i < rows.size(); ++i)
            EXPECT_EQ(few.field(k)[i], fields.field(k)[rows[i]]) << orientation_feature_names()[k];
}

TEST(PixelFeatures, AreFiniteAndDirectionsUnitOrNone) {
    HostTools host;
    const HatchingSurface box = measure_surface(shapes::box(1, 2, 3, 5));
    for (const Vec3& direction : {Vec3(1, 2, 3), Vec3(0, 0, 1)}) {
        const HatchingView view = parallel_view(box.mesh, direction);
        PixelFeatures features(box, view, host.tools);
        const FeatureMatrix all = features.scalars(all_features(), {});
        EXPECT_TRUE(std::ranges::all_of(all.values, [](float value) { return std::isfinite(value); }));
        const OrientationFields fields = features.orientations({});
        for (const DoubledAngle& v : fields.values) {
            const float length = std::hypot(v[0], v[1]);
            ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-4f) << length;
        }
    }
}

/// Sides of a box are flat pictures: their gradients are those of the edges around, rather than none.
TEST(PixelFeatures, FlatPicturesHaveTheDirectionsAround) {
    HostTools host;
    const HatchingSurface box = measure_surface(shapes::box(1, 1, 1, 5));
    const HatchingView at_corner = parallel_view(box.mesh, Vec3(1, 1, 1));
    PixelFeatures corner(box, at_corner, host.tools);
    OrientationFields fields = corner.orientations({});
    for (const DoubledAngle& v : fields.field(field_of_view("grad V.N,1"))) ASSERT_NE(v, DoubledAngle{});
    // A picture that is flat all over has no direction anywhere.
    const HatchingSurface sheet = measure_surface(shapes::grid(8, 8, 1));
    const HatchingView from_above = parallel_view(sheet.mesh, sheet.normals[0]);
    PixelFeatures flat(sheet, from_above, host.tools);
    OrientationFields none = flat.orientations({});
    for (const DoubledAngle& v : none.field(field_of_view("grad V.N,1"))) ASSERT_EQ(v, DoubledAngle{});
}

TEST(PixelFeatures, DoNotDependOnTheSizeOfTheMeshNorItsPlace) {
    HostTools host;
    const TriangleMesh moved = shapes::translated(shapes::scaled(ring().mesh, 8), Vec3(64, -32, 16));
    const HatchingSurface other = measure_surface(moved);
    const HatchingView view = parallel_view(ring().mesh, Vec3(1, 2, 3)),
                       other_view = parallel_view(moved, Vec3(1, 2, 3));
    PixelFeatures here(ring(), view, host.tools), there(other, other_view, host.tools);
    ASSERT_NEAR(static_cast<double>(here.size()), static_cast<double>(there.size()), 10);
    const FeatureMatrix a = here.scalars(all_features(), {}), b = there.scalars(all_features(), {});
    for (std::size_t k = 0; k < k_pixel_features; ++k) {
        const auto mean_of = [&](const FeatureMatrix& all) {
            return std::accumulate(all.column(k).begin(), all.column(k).end(), 0.0) / static_cast<double>(all.rows);
        };
        double size = 0;
        for (const float value : a.column(k)) size = std::max(size, static_cast<double>(std::abs(value)));
        EXPECT_NEAR(mean_of(a), mean_of(b), 0.005 * size) << a.names[k];
    }
}

TEST(PixelFeatures, AreTheSameOnAnyNumberOfThreads) {
    std::vector<std::vector<float>> values;
    std::vector<std::vector<DoubledAngle>> directions;
    const HatchingView view = parallel_view(ring().mesh, Vec3(1, 2, 3));
    for (const std::size_t threads : {1u, 2u, 5u}) {
        const ThreadLimit limit(threads);
        HostTools host;
        PixelFeatures features(ring(), view, host.tools);
        values.push_back(features.scalars(all_features(), {}).values);
        directions.push_back(features.orientations({}).values);
    }
    for (const std::size_t k : {1u, 2u}) {
        EXPECT_EQ(values[0], values[k]);
        EXPECT_EQ(directions[0], directions[k]);
    }
}

/// Two parts: the upper and the lower half.
FaceLabels upper_and_lower(const TriangleMesh& mesh) {
    FaceLabels labels{{"lower", "upper"}, {}};
    for (const Face& face : mesh.faces) {
        const float y = mesh.vertices[face[0]].y() + mesh.vertices[face[1]].y() + mesh.vertices[face[2]].y();
        labels.label.push_back(y > 0 ? 1 : 0);
    }
    return labels;
}

TEST(PixelFeatures, TellThePartsThatAStyleKnows) {
    HostTools host;
    const HatchingView view = parallel_view(ball().mesh, Vec3::UnitZ());
    PixelFeatures features(ball(), view, host.tools);
    const FaceLabels labels = upper_and_lower(ball().mesh);
    features.set_labels(labels);
    EXPECT_EQ(features.scalar_count(), k_pixel_features);
    // The style's order counts; a part that this mesh lacks is nowhere.
    features.use_parts(std::vector<std::string>{"upper", "tail"});
    ASSERT_EQ(features.scalar_count(), k_pixel_features + 2);
    const std::vector<std::uint32_t> which{0, k_pixel_features, k_pixel_features + 1};
    const FeatureMatrix matrix = features.scalars(which, {});
    EXPECT_EQ(matrix.names[1], "part.upper");
    std::array<std::size_t, 2> seen{};
    for (std::size_t i = 0; i < matrix.rows; ++i) {
        const std::int32_t label = labels.label[features.gbuffer().face[features.pixels().pixel[i]]];
        ASSERT_EQ(matrix.column(1)[i], static_cast<float>(label)) << i;
        ASSERT_EQ(matrix.column(2)[i], 0.0f) << i;
        ++seen[static_cast<std::size_t>(label)];
    }
    EXPECT_GT(seen[0], 100U);
    EXPECT_GT(seen[1], 100U);
}

TEST(PixelFeatures, RefuseStylesWhosePartsAreNotLabeled) {
    HostTools host;
    const HatchingView view = parallel_view(ball().mesh, Vec3::UnitZ());
    PixelFeatures features(ball(), view, host.tools);
    const std::vector<std::string> parts{"head", "tail"};
    EXPECT_THROW(features.use_parts(parts), UsageError);
    EXPECT_THROW(features.set_labels({{"head"}, std::vector<std::int32_t>(3)}), UsageError);
    features.set_labels(upper_and_lower(ball().mesh));
    EXPECT_THROW(features.use_parts(parts), UsageError);
    features.use_parts({});
    EXPECT_EQ(features.scalar_count(), k_pixel_features);
}

TEST(PixelFeatures, RefuseAViewThatShowsNothing) {
    HostTools host;
    HatchingView view = parallel_view(ball().mesh, Vec3::UnitZ());
    view.camera.view = look_at(Vec3(0, 0, 10), Vec3(0, 0, 20));
    EXPECT_THROW(PixelFeatures(ball(), view, host.tools), DataError);
}

}  // namespace
}  // namespace exemplar
