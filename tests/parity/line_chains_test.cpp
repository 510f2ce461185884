#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "tests/parity/line_scene.h"

namespace exemplar {
namespace {

using namespace test_support;

/// A chain as the numbers of its segments, with what is walked from the second end.
using Walk = std::vector<std::pair<std::uint32_t, bool>>;

struct FoundChains {
    Found found;
    std::vector<LinePoint> points;
    std::vector<Walk> walks;  // by first segment
    std::vector<bool> closed;
};

FoundChains chain_on_device(const Scene& scene, std::uint32_t families, const LineOptions& options,
                            const Camera& camera) {
    GpuLineExtraction lines(scene.line_surface);
    GpuChains chains(lines);
    Stream stream(shared_device());
    lines.record(stream, scene.snapshot(), families, on_device(options));
    chains.record(stream, scene.vertices, camera, picture_width(), picture_height());
    stream.finish();
    FoundChains result{};
    lines.counts().download(std::span(&result.found.counts, 1));
    result.found.segments.resize(result.found.counts.segments);
    lines.segments().download(std::span(result.found.segments));
    result.points.resize(result.found.counts.points);
    chains.points().download(std::span(result.points));
    for (const LinePoint& point : result.points) {
        if (point.kind & shared::k_point_first) {
            result.walks.emplace_back();
            result.closed.push_back(point.kind & shared::k_point_closed);
        }
        if (!(point.kind & shared::k_point_last))
            result.walks.back().emplace_back(point.segment / 2, point.segment % 2);
    }
    return result;
}

/// How many chains both have.
std::size_t expect_same_chains(const Scene& scene, const std::vector<LineType>& types) {
    const Camera camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), picture_aspect());
    const FoundChains found =
        chain_on_device(scene, line_families(types),
                        {.eye = camera.position(), .feature_size = scene.size(), .thresholds = {}}, camera);
    std::set<std::pair<bool, Walk>> expected, actual;
    for (const LineType type : types) {
        const ReadSegments own = segments_of_type(found.found.segments, type);
        for (const Chain& chain : chain_segments(scene.mesh.faces, scene.neighbors, own.segments)) {
            Walk walk;
            for (const ChainLink& link : chain.links) walk.emplace_back(own.numbers[link.segment], link.reversed);
            expected.emplace(chain.closed, walk);
        }
    }
    std::size_t walked = 0;
    for (std::size_t i = 0; i < found.walks.size(); ++i) {
        actual.emplace(found.closed[i], found.walks[i]);
        walked += found.walks[i].size();
    }
    EXPECT_EQ(walked, found.found.segments.size());
    EXPECT_EQ(actual, expected);
    return expected.size();
}

TEST(ChainParity, ChainsAreThoseOfTheReference) {
    const Scene scene(mixed()), smooth(lumpy());
    // Together with contours, creases lack those on the outline, and contours lack boundaries.
    const std::vector<LineType> apart = {k_line_types.begin() + 1, k_line_types.end()};
    std::size_t one_by_one = 0;
    for (const LineType type : apart) one_by_one += expect_same_chains(scene, {type});
    EXPECT_EQ(expect_same_chains(scene, apart), one_by_one);
    EXPECT_GT(expect_same_chains(scene, {k_line_types.begin(), k_line_types.end()}), 100u);
    EXPECT_GT(expect_same_chains(smooth, {k_line_types.begin(), k_line_types.end() - 2}), 20u);
}

TEST(ChainParity, PointsAreWhereTheCameraSeesThem) {
    const Scene scene(mixed());
    const Camera camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), picture_aspect());
    const FoundChains found =
        chain_on_device(scene, 3, {.eye = camera.position(), .feature_size = scene.size(), .thresholds = {}}, camera);
    float along = 0;
    for (std::size_t i = 0; i < found.points.size(); ++i) {
        const LinePoint& point = found.points[i];
        const LineSegmentRecord& s = found.found.segments[point.segment / 2];
        const bool second = (point.segment % 2 != 0) != ((point.kind & shared::k_point_last) != 0);
        const float b = second ? s.ends.z : s.ends.x, c = second ? s.ends.w : s.ends.y;
        const Face& face = scene.mesh.faces[s.face];
        const Vec3 at = (1 - b - c) * scene.mesh.vertices[face[0]] + b * scene.mesh.vertices[face[1]] +
                        c * scene.mesh.vertices[face[2]];
        const Vec3 seen = camera.project(at, picture_width(), picture_height());
        ASSERT_NEAR(point.x, seen.x(), 2e-3f);
        ASSERT_NEAR(point.y, seen.y(), 2e-3f);
        ASSERT_NEAR(point.depth, seen.z(), 1e-5f);
        if (point.kind & shared::k_point_first)
            along = 0;
        else
            along += std::hypot(point.x - found.points[i - 1].x, point.y - found.points[i - 1].y);
        ASSERT_NEAR(point.parameter, along, 1e-3f + 1e-4f * along);
        if (point.kind & shared::k_point_closed && point.kind & shared::k_point_last) {
            const auto first =
                std::find_if(found.points.rend() - static_cast<std::ptrdiff_t>(i) - 1, found.points.rend(),
                             [](const LinePoint& p) { return p.kind & shared::k_point_first; });
            EXPECT_NEAR(first->x, point.x, 1e-2f);
            EXPECT_NEAR(first->y, point.y, 1e-2f);
        }
    }
    EXPECT_GT(found.points.size(), 100u);
}

TEST(ChainParity, RerunsAreTheSameBytes) {
    const Scene scene(mixed());
    const Camera camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), picture_aspect());
    const LineOptions options{.eye = camera.position(), .feature_size = scene.size(), .thresholds = {}};
    const FoundChains once = chain_on_device(scene, 0x3ff, options, camera);
    for (int i = 0; i < 5; ++i) {
        const FoundChains again = chain_on_device(scene, 0x3ff, options, camera);
        ASSERT_EQ(once.points.size(), again.points.size());
        EXPECT_EQ(0, std::memcmp(once.points.data(), again.points.data(), once.points.size() * sizeof(LinePoint)));
    }
}

}  // namespace
}  // namespace exemplar
