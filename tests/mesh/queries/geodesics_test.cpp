#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "host/core/parallel.h"
#include "host/mesh/queries/geodesics.h"
#include "host/mesh/topology.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr float k_infinity = std::numeric_limits<float>::infinity();

DualGraph graph_of(const TriangleMesh& mesh) {
    return build_dual_graph(mesh, build_topology(mesh));
}

std::vector<float> distances_from(const DualGraph& graph, std::uint32_t source) {
    std::vector<float> out(graph.face_count());
    GeodesicSearch(graph).distances(source, out);
    return out;
}

/// Dijkstra by the book: no heap, only the graph.
std::vector<float> naive_distances(const DualGraph& graph, std::uint32_t source) {
    std::vector<float> distance(graph.face_count(), k_infinity);
    std::vector<bool> settled(graph.face_count());
    distance[source] = 0;
    for (;;) {
        std::uint32_t best = k_invalid_index;
        for (std::uint32_t f = 0; f < distance.size(); ++f)
            if (!settled[f] && distance[f] < k_infinity && (best == k_invalid_index || distance[f] < distance[best]))
                best = f;
        if (best == k_invalid_index) return distance;
        settled[best] = true;
        for (std::uint32_t a = graph.begin[best]; a < graph.begin[best + 1]; ++a)
            distance[graph.arcs[a].face] =
                std::min(distance[graph.arcs[a].face], distance[best] + graph.arcs[a].length);
    }
}

/// A lumpy sphere with faces of uneven size in random order.
TriangleMesh lumpy_sphere(int subdivisions, std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh = shapes::icosphere(subdivisions, 1);
    for (Vec3& p : mesh.vertices) p *= static_cast<float>(random.uniform(0.9, 1.3));
    return shapes::with_shuffled_faces(mesh, seed);
}

TEST(DualGraph, ArcsRunOverTheEdgeMidpoint) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, -6, 0}};
    mesh.faces = {{0, 1, 2}, {1, 0, 3}};
    const DualGraph graph = graph_of(mesh);
    ASSERT_THAT(graph.begin, testing::ElementsAre(0, 1, 2));
    EXPECT_EQ(graph.arcs[0].face, 1u);
    // Centers (1, 1) and (1, -2), midpoint (1.5, 0).
    EXPECT_NEAR(graph.arcs[0].length, std::sqrt(0.25 + 1) + std::sqrt(0.25 + 4), 1e-6);
    EXPECT_EQ(graph.arcs[1].length, graph.arcs[0].length);
}

TEST(Geodesics, AgreeWithNaiveDijkstra) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const DualGraph graph = graph_of(lumpy_sphere(3, seed));
        const auto source = static_cast<std::uint32_t>(Random(seed).index(graph.face_count()));
        EXPECT_EQ(distances_from(graph, source), naive_distances(graph, source));
    }
}

TEST(Geodesics, AreSymmetric) {
    const DualGraph graph = graph_of(lumpy_sphere(3, 9));
    std::vector<std::uint32_t> all(graph.face_count());
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<float> d = distances_from_sources(graph, all);
    for (std::size_t i = 0; i < all.size(); i += 7)
        for (std::size_t j = 0; j < all.size(); ++j) EXPECT_NEAR(d[i * all.size() + j], d[j * all.size() + i], 1e-5);
}

TEST(Geodesics, OnAPlaneAreWithinTheBoundOfTheDualGraph) {
    // With cells of size 1 cut along one diagonal, a step over a diagonal costs sqrt(2) / 3 and one over another edge
    // sqrt(5) / 3. Straight along the cut diagonals two of the latter suffice; along the other diagonals a cell takes
    // two of each: (2 sqrt(2) + 2 sqrt(5)) / (3 sqrt(2)) = 1.7208 times the straight way, the worst direction.
    constexpr float k_cell = 1.0f / 40, k_worst = 1.7208f;
    const TriangleMesh mesh = shapes::grid(40, 40, 1);
    const DualGraph graph = graph_of(mesh);
    const std::vector<Vec3> centers = face_centers(mesh);
    const std::uint32_t source = 40 * 40 + 40;
    const std::vector<float> d = distances_from(graph, source);
    float worst = 0;
    for (std::size_t f = 0; f < d.size(); ++f) {
        const float straight = (centers[f] - centers[source]).norm();
        EXPECT_GE(d[f], straight * 0.99999f);
        EXPECT_LE(d[f], k_worst * straight + k_cell);
        if (straight > 0.5f) worst = std::max(worst, d[f] / straight);
    }
    EXPECT_NEAR(worst, k_worst, 0.02f);
    const std::uint32_t along_cut = source + 2 * (40 + 1) * 10;  // ten cells to the right and up
    EXPECT_NEAR(d[along_cut], 10 * k_cell * 2 * std::sqrt(5.0) / 3, 1e-5);
}

TEST(Geodesics, OnASphereAreWithinTheBoundOfTheDualGraph) {
    // Among equilateral triangles the dual graph is a honeycomb, which is 2 / sqrt(3) to 4 / 3 times too long;
    // an icosphere's triangles are nearly that.
    const TriangleMesh mesh = shapes::icosphere(5, 1);
    const std::vector<float> d = distances_from(graph_of(mesh), 123);
    const std::vector<Vec3> centers = face_centers(mesh);
    for (std::size_t f = 0; f < d.size(); ++f) {
        const float arc = std::acos(std::clamp(centers[f].normalized().dot(centers[123].normalized()), -1.0f, 1.0f));
        EXPECT_GE(d[f], 1.05f * arc - 0.05f);
        EXPECT_LE(d[f], 1.4f * arc + 0.05f);
    }
}

TEST(Geodesics, WithinGivesTheFacesInsideTheRadiusInOrder) {
    const DualGraph graph = graph_of(lumpy_sphere(3, 2));
    GeodesicSearch search(graph);
    for (const float radius : {0.0f, 0.1f, 0.5f, 1.3f, k_infinity, 0.3f}) {  // the last must not see earlier searches
        const std::vector<float> all = naive_distances(graph, 17);
        const auto reached = search.within(17, radius);
        EXPECT_EQ(static_cast<long>(reached.size()), std::ranges::count_if(all, [&](float d) { return d <= radius; }));
        EXPECT_TRUE(std::ranges::is_sorted(reached, {}, &GeodesicSearch::Reached::distance));
        for (const auto& [face, distance] : reached) EXPECT_EQ(distance, all[face]);
        EXPECT_EQ(reached.front().face, 17u);
    }
    EXPECT_TRUE(search.within(17, -1).empty());
}

TEST(Geodesics, WithinGivesTheNearestFacesOfABoundedNumber) {
    const DualGraph graph = graph_of(lumpy_sphere(3, 2));
    GeodesicSearch search(graph);
    const auto found = search.within(17, k_infinity);
    const std::vector<GeodesicSearch::Reached> all(found.begin(), found.end());
    EXPECT_EQ(search.complete_distance(), k_infinity);
    for (const std::size_t bound : {std::size_t{1}, std::size_t{2}, std::size_t{100}, all.size() - 1}) {
        const auto reached = search.within(17, k_infinity, bound);
        ASSERT_EQ(reached.size(), bound);
        for (std::size_t i = 0; i < bound; ++i) EXPECT_EQ(reached[i].distance, all[i].distance);
        EXPECT_EQ(search.complete_distance(), all[bound].distance);
        // What the bounded search has left out is not seen by the next.
        EXPECT_EQ(search.within(17, k_infinity).size(), all.size());
        EXPECT_EQ(search.complete_distance(), k_infinity);
    }
    EXPECT_EQ(search.within(17, k_infinity, all.size()).size(), all.size());
    EXPECT_EQ(search.complete_distance(), k_infinity);
}

TEST(Geodesics, WithinAndDistancesMayAlternate) {
    const DualGraph graph = graph_of(lumpy_sphere(2, 2));
    GeodesicSearch search(graph);
    std::vector<float> out(graph.face_count());
    const std::size_t before = search.within(3, 0.6f).size();
    search.distances(5, out);
    EXPECT_EQ(search.within(3, 0.6f).size(), before);
    EXPECT_EQ(out, naive_distances(graph, 5));
}

TEST(Geodesics, OtherComponentsAreInfinitelyFar) {
    const TriangleMesh mesh = shapes::joined(shapes::icosphere(1, 1), shapes::icosphere(1, 1));
    const std::vector<float> d = distances_from(graph_of(mesh), 100);
    for (std::size_t f = 0; f < d.size(); ++f) EXPECT_EQ(d[f] == k_infinity, f < 80) << f;
}

TEST(Geodesics, FromManySourcesEqualSingleSearchesOnAnyThreadCount) {
    const DualGraph graph = graph_of(lumpy_sphere(2, 4));
    const std::vector<std::uint32_t> sources = {0, 11, 11, 319, 42, 7, 100, 101, 102};
    std::vector<float> expected;
    for (std::uint32_t s : sources) {
        const std::vector<float> row = distances_from(graph, s);
        expected.insert(expected.end(), row.begin(), row.end());
    }
    EXPECT_EQ(distances_from_sources(graph, sources), expected);
    const ThreadLimit one(1);
    EXPECT_EQ(distances_from_sources(graph, sources), expected);
    EXPECT_TRUE(distances_from_sources(graph, {}).empty());
}

TEST(FaceSamples, CoverTheSurfaceAndShareItsArea) {
    const TriangleMesh mesh = shapes::icosphere(5, 1);
    const DualGraph graph = graph_of(mesh);
    const FaceSamples samples = sample_faces(mesh, graph, 100);
    ASSERT_EQ(samples.face.size(), 100u);
    EXPECT_EQ(std::set<std::uint32_t>(samples.face.begin(), samples.face.end()).size(), 100u);
    EXPECT_NEAR(std::accumulate(samples.area_share.begin(), samples.area_share.end(), 0.0), 1, 1e-5);

    const std::vector<float> d = distances_from_sources(graph, samples.face);
    float covering = 0, packing = k_infinity;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        float nearest = k_infinity;
        for (std::size_t s = 0; s < 100; ++s) nearest = std::min(nearest, d[s * mesh.face_count() + f]);
        covering = std::max(covering, nearest);
    }
    for (std::size_t s = 0; s < 100; ++s)
        for (std::size_t t = 0; t < 100; ++t)
            if (s != t) packing = std::min(packing, d[s * mesh.face_count() + samples.face[t]]);
    // Farthest points: no two samples are nearer to each other than the worst-covered face is to its sample.
    EXPECT_LE(covering, packing * 1.0001f);
    // Disks of the covering radius hold the whole area: 100 pi r^2 >= 4 pi; and distances overestimate little.
    EXPECT_GE(covering, 0.2f * 0.9f);
    EXPECT_LE(covering, 0.2f * 2);
}

TEST(FaceSamples, SharesAreTheAreasOfTheVoronoiCells) {
    const TriangleMesh mesh = lumpy_sphere(3, 5);
    const DualGraph graph = graph_of(mesh);
    const FaceSamples samples = sample_faces(mesh, graph, 37);
    const std::vector<float> d = distances_from_sources(graph, samples.face), areas = face_areas(mesh);
    std::vector<double> cell(37);
    double total = 0;
    for (std::size_t f = 0; f < areas.size(); ++f) {
        std::size_t nearest = 0;
        for (std::size_t s = 1; s < 37; ++s)
            if (d[s * areas.size() + f] < d[nearest * areas.size() + f]) nearest = s;
        cell[nearest] += areas[f];
        total += areas[f];
    }
    for (std::size_t s = 0; s < 37; ++s) EXPECT_NEAR(samples.area_share[s], cell[s] / total, 1e-6);
}

TEST(FaceSamples, DoNotDependOnFaceOrder) {
    for (const TriangleMesh& mesh :
         {lumpy_sphere(3, 6), shapes::joined(shapes::torus(3, 1, 30, 15), shapes::box(1, 2, 3, 3))}) {
        std::vector<std::uint32_t> permutation;
        const TriangleMesh shuffled = shapes::with_shuffled_faces(mesh, 77, &permutation);
        const FaceSamples a = sample_faces(mesh, graph_of(mesh), 50);
        FaceSamples b = sample_faces(shuffled, graph_of(shuffled), 50);
        for (std::uint32_t& f : b.face) f = permutation[f];
        EXPECT_EQ(a.face, b.face);
        for (std::size_t s = 0; s < 50; ++s) EXPECT_NEAR(a.area_share[s], b.area_share[s], 1e-6);
    }
}

TEST(FaceSamples, EstimateMeansOverAllFaces) {
    const TriangleMesh mesh = lumpy_sphere(4, 8);
    const DualGraph graph = graph_of(mesh);
    const FaceSamples samples = sample_faces(mesh, graph, 400);
    const std::vector<float> d = distances_from(graph, 5), areas = face_areas(mesh);
    double exact = 0, total = 0, estimate = 0;
    for (std::size_t f = 0; f < areas.size(); ++f) exact += double(areas[f]) * double(d[f]), total += areas[f];
    for (std::size_t s = 0; s < samples.face.size(); ++s)
        estimate += double(samples.area_share[s]) * double(d[samples.face[s]]);
    EXPECT_NEAR(estimate, exact / total, 0.01 * exact / total);
}

TEST(FaceSamples, EveryComponentGetsOneTheLargestFirst) {
    TriangleMesh mesh = shapes::icosphere(1, 0.3f);
    for (int i = 1; i < 7; ++i)
        mesh = shapes::joined(mesh, shapes::translated(shapes::icosphere(0, 0.1f), {static_cast<float>(i), 0, 0}));
    const std::vector<std::uint32_t> component = face_components(mesh, build_topology(mesh));
    const FaceSamples samples = sample_faces(mesh, graph_of(mesh), 7);
    std::set<std::uint32_t> hit;
    for (std::uint32_t f : samples.face) hit.insert(component[f]);
    EXPECT_EQ(hit.size(), 7u);
    // Too few for all: the largest first.
    const FaceSamples two = sample_faces(mesh, graph_of(mesh), 2);
    EXPECT_EQ(component[two.face[0]], 0u);
    EXPECT_NE(component[two.face[1]], 0u);
    EXPECT_GT(two.area_share[0], 0.8f);
    EXPECT_NEAR(two.area_share[0] + two.area_share[1], 1, 1e-6);
}

TEST(FaceSamples, ComponentsWithoutAreaHaveNoShare) {
    // A needle far away would be sampled first, and has no area to share.
    TriangleMesh needle;
    needle.vertices = {{50, 0, 0}, {51, 0, 0}, {52, 0, 0}};
    needle.faces = {{0, 1, 2}};
    const TriangleMesh mesh = shapes::joined(needle, shapes::icosphere(1, 1));
    for (std::size_t count : {1, 2, 3, 81}) {
        const FaceSamples samples = sample_faces(mesh, graph_of(mesh), count);
        ASSERT_EQ(samples.face.size(), count);
        float total = 0;
        for (std::size_t s = 0; s < count; ++s) {
            total += samples.area_share[s];
            if (samples.face[s] == 0) {
                EXPECT_EQ(samples.area_share[s], 0);
            }
        }
        EXPECT_NEAR(total, 1, 1e-6) << count;
    }
}

TEST(FaceSamples, OfOddCountsAreSound) {
    const TriangleMesh mesh = shapes::box(1, 2, 3, 1);
    const DualGraph graph = graph_of(mesh);
    EXPECT_TRUE(sample_faces(mesh, graph, 0).face.empty());
    EXPECT_TRUE(sample_faces({}, graph_of({}), 5).face.empty());
    EXPECT_EQ(sample_faces(mesh, graph, 1).area_share, std::vector<float>{1.0f});
    for (std::size_t count : {std::size_t{12}, std::size_t{1000}}) {
        const FaceSamples all = sample_faces(mesh, graph, count);
        const std::vector<float> areas = face_areas(mesh);
        ASSERT_EQ(all.face.size(), 12u);
        for (std::uint32_t f = 0; f < 12; ++f) {
            EXPECT_EQ(all.face[f], f);
            EXPECT_NEAR(all.area_share[f], areas[f] / 22, 1e-6);
        }
    }
}

TEST(FaceSamples, OfCoincidingFacesAreDistinct) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}};
    mesh.faces.assign(10, {0, 0, 0});
    const FaceSamples samples = sample_faces(mesh, graph_of(mesh), 4);
    EXPECT_EQ(std::set<std::uint32_t>(samples.face.begin(), samples.face.end()).size(), 4u);
    EXPECT_NEAR(std::accumulate(samples.area_share.begin(), samples.area_share.end(), 0.0), 1, 1e-6);

    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.faces.assign(10, {0, 1, 2});  // arcs between them have length, centers coincide
    EXPECT_EQ(sample_faces(mesh, graph_of(mesh), 4).face.size(), 4u);
}

}  // namespace
}  // namespace exemplar
