#include "host/lines/strokes/chains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "host/core/errors.h"
#include "tests/lines/extraction/measured_surface.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A lumpy sphere, or another mesh, with estimated curvature and neighbors.
struct ChainSurface : test_support::MeasuredSurface {
    using MeasuredSurface::MeasuredSurface;

    std::vector<LineSegment> lines(LineType type, const Vec3& eye = {3, 2, 4}) const {
        LineOptions options;
        options.eye = eye;
        options.feature_size = 0.18f;
        return extract_lines(surface(), type, options);
    }
    Vec3 at(const LineSegment& segment, std::size_t end) const {
        Vec3 point = Vec3::Zero();
        for (std::size_t i = 0; i < 3; ++i) point += segment.ends[end][i] * mesh.vertices[mesh.faces[segment.face][i]];
        return point;
    }
};

TriangleMesh lumpy_sphere(int subdivisions) {
    return shapes::transformed(shapes::icosphere(subdivisions, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.2f * std::sin(3 * p.x() + 1) + 0.15f * p.y() * std::cos(4 * p.z()));
    });
}

/// Where an end lies, said by vertices alone: of an edge with exactly two faces, or one vertex; nothing elsewhere.
std::vector<std::uint32_t> place_of(const ChainSurface& surface, const LineSegment& segment, std::size_t end) {
    const Face& face = surface.mesh.faces[segment.face];
    const SegmentEnd place = segment.places[end];
    if (place >= k_inside_face) return {};
    if (place >= k_at_corner) return {face[place - k_at_corner]};
    std::vector<std::uint32_t> edge = {face[place], face[(place + 1u) % 3]};
    std::sort(edge.begin(), edge.end());
    std::size_t faces = 0;
    for (const Face& other : surface.mesh.faces)
        faces += std::count(other.begin(), other.end(), edge[0]) + std::count(other.begin(), other.end(), edge[1]) == 2
                     ? 1u
                     : 0u;
    return faces == 2 ? edge : std::vector<std::uint32_t>{};
}

std::size_t entered(const ChainLink& link) {
    return link.reversed ? 1 : 0;
}

/// Everything that chains.h promises of chains, found out the slow way.
void expect_chains_of(const ChainSurface& surface, const std::vector<LineSegment>& segments,
                      const std::vector<Chain>& chains) {
    std::map<std::pair<int, std::vector<std::uint32_t>>, std::set<std::pair<std::uint32_t, std::size_t>>> meeting;
    for (std::uint32_t s = 0; s < segments.size(); ++s)
        for (std::size_t e : {0, 1})
            if (auto place = place_of(surface, segments[s], e); !place.empty())
                meeting[{segments[s].family, place}].insert({s, e});
    const auto next_of = [&](std::uint32_t s, std::size_t e) -> std::optional<std::pair<std::uint32_t, std::size_t>> {
        const auto place = place_of(surface, segments[s], e);
        if (place.empty()) return std::nullopt;
        const auto& ends = meeting[{segments[s].family, place}];
        if (ends.size() != 2) return std::nullopt;
        return *ends.begin() == std::pair{s, e} ? *std::next(ends.begin()) : *ends.begin();
    };
    std::vector<int> times(segments.size(), 0);
    std::uint32_t last_smallest = 0;
    for (std::size_t c = 0; c < chains.size(); ++c) {
        const Chain& chain = chains[c];
        ASSERT_FALSE(chain.links.empty());
        const std::size_t count = chain.links.size();
        for (std::size_t i = 0; i < count; ++i) {
            const ChainLink& link = chain.links[i];
            ASSERT_LT(link.segment, segments.size());
            ++times[link.segment];
            const auto next = next_of(link.segment, 1 - entered(link));
            if (i + 1 == count && !chain.closed) {
                EXPECT_EQ(next, std::nullopt);
                continue;
            }
            const ChainLink& follower = chain.links[(i + 1) % count];
            ASSERT_TRUE(next.has_value());
            EXPECT_EQ(*next, std::pair(follower.segment, entered(follower)));
            EXPECT_LT((surface.at(segments[link.segment], 1 - entered(link)) -
                       surface.at(segments[follower.segment], entered(follower)))
                          .norm(),
                      1e-5f);
        }
        if (!chain.closed) {
            EXPECT_EQ(next_of(chain.links[0].segment, entered(chain.links[0])), std::nullopt);
        }
        const auto smallest =
            std::min_element(chain.links.begin(), chain.links.end(),
                             [](const ChainLink& a, const ChainLink& b) { return a.segment < b.segment; });
        EXPECT_FALSE(smallest->reversed);
        if (chain.closed) {
            EXPECT_EQ(smallest, chain.links.begin());
        }
        if (c > 0) {
            EXPECT_GT(smallest->segment, last_smallest);
        }
        last_smallest = smallest->segment;
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(segments.size()));
}

std::vector<Chain> chains_of(const ChainSurface& surface, const std::vector<LineSegment>& segments) {
    return chain_segments(surface.mesh.faces, surface.neighbors, segments);
}

class ChainsOfEveryLine : public ::testing::TestWithParam<LineType> {};

TEST_P(ChainsOfEveryLine, JoinWhatContinues) {
    const ChainSurface surface(lumpy_sphere(4));
    const auto segments = surface.lines(GetParam());
    if (GetParam() != LineType::creases && GetParam() != LineType::boundaries) {
        EXPECT_GT(segments.size(), 10);
    }
    const auto chains = chains_of(surface, segments);
    expect_chains_of(surface, segments, chains);
    EXPECT_LE(chains.size(), segments.size() / 2 + 5);
}

TEST_P(ChainsOfEveryLine, AreOfTheSameSegmentsInAnyOrder) {
    const ChainSurface surface(lumpy_sphere(4));
    auto segments = surface.lines(GetParam());
    const auto sets_of = [&](const std::vector<std::uint32_t>& name) {
        std::set<std::set<std::uint32_t>> sets;
        for (const Chain& chain : chains_of(surface, segments)) {
            std::set<std::uint32_t> members;
            for (const ChainLink& link : chain.links) members.insert(name[link.segment]);
            sets.insert(members);
        }
        return sets;
    };
    std::vector<std::uint32_t> name(segments.size());
    for (std::uint32_t s = 0; s < name.size(); ++s) name[s] = s;
    const auto before = sets_of(name);
    Random random(3);
    for (std::size_t i = segments.size(); i > 1; --i) {
        const std::size_t j = random.index(i);
        std::swap(segments[i - 1], segments[j]);
        std::swap(name[i - 1], name[j]);
    }
    EXPECT_EQ(sets_of(name), before);
    expect_chains_of(surface, segments, chains_of(surface, segments));
}

INSTANTIATE_TEST_SUITE_P(AllTypes, ChainsOfEveryLine, ::testing::ValuesIn(k_line_types),
                         [](const auto& type) { return std::string(name_of(type.param)); });

TEST(Chains, OfAClosedSurfacesContourAreLoops) {
    const ChainSurface surface(shapes::torus(3, 1, 60, 20));
    for (const Vec3& eye : {Vec3(9, 2, 4), Vec3(0.3f, -12, 1), Vec3(0.1f, 0.2f, 8)}) {
        const auto segments = surface.lines(LineType::contours, eye);
        const auto chains = chains_of(surface, segments);
        EXPECT_EQ(chains.size(), 2);
        for (const Chain& chain : chains) EXPECT_TRUE(chain.closed);
        expect_chains_of(surface, segments, chains);
    }
}

TEST(Chains, OfAnOpenCylindersRimsAreTwoLoops) {
    const ChainSurface surface(shapes::cylinder(1, 2, 12, 3, false));
    const auto segments = surface.lines(LineType::boundaries);
    EXPECT_EQ(segments.size(), 24);
    EXPECT_TRUE(surface.lines(LineType::creases).empty());  // its faces meet at 30 degrees, creases begin at 40
    const auto chains = chains_of(surface, segments);
    ASSERT_EQ(chains.size(), 2);
    for (const Chain& chain : chains) {
        EXPECT_TRUE(chain.closed);
        EXPECT_EQ(chain.links.size(), 12);
    }
    expect_chains_of(surface, segments, chains);
}

TEST(Chains, OfACubesEdgesEndAtItsCorners) {
    const ChainSurface surface(shapes::box(1, 1, 1, 4));
    const auto segments = surface.lines(LineType::creases);
    EXPECT_EQ(segments.size(), 12 * 4);
    for (const LineSegment& segment : segments)
        for (const float strength : segment.strength) EXPECT_NEAR(strength, std::numbers::pi / 2, 1e-5);
    EXPECT_TRUE(surface.lines(LineType::boundaries).empty());
    const auto chains = chains_of(surface, segments);
    EXPECT_EQ(chains.size(), 12);
    for (const Chain& chain : chains) {
        EXPECT_FALSE(chain.closed);
        EXPECT_EQ(chain.links.size(), 4);
    }
    expect_chains_of(surface, segments, chains);
}

/// Three faces at the edge 0-1.
TriangleMesh fan() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5f}, {-0.5f, 0.8f, 0.5f}, {-0.5f, -0.8f, 0.5f}};
    mesh.faces = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    return mesh;
}

TEST(Chains, StopWhereThreeFacesMeet) {
    const ChainSurface surface(fan());
    const auto creases = surface.lines(LineType::creases);
    ASSERT_EQ(creases.size(), 1);  // once, whatever the angle
    EXPECT_EQ(creases[0].face, 0);
    EXPECT_FLOAT_EQ(creases[0].strength[0], std::numbers::pi_v<float>);
    const auto boundaries = surface.lines(LineType::boundaries);
    EXPECT_EQ(boundaries.size(), 6);
    const auto chains = chains_of(surface, boundaries);
    EXPECT_EQ(chains.size(), 3);  // around each face, from 0 to 1: there three end
    expect_chains_of(surface, boundaries, chains);
    // A line across the edge has two ways on, so it takes none.
    std::vector<LineSegment> across(3);
    for (std::uint32_t f = 0; f < 3; ++f) {
        across[f].face = f;
        across[f].places = {0, 1};
        across[f].ends = {{{0.5f, 0.5f, 0}, {0, 0.5f, 0.5f}}};
    }
    EXPECT_EQ(chains_of(surface, across).size(), 3);
}

TEST(Chains, KeepFamiliesApart) {
    const ChainSurface surface(shapes::grid(1, 1, 1));
    ASSERT_EQ(surface.neighbors[0][2], 4u * 1 + 0);
    std::vector<LineSegment> segments(2);
    segments[0].face = 0;
    segments[0].places = {0, 2};
    segments[1].face = 1;
    segments[1].places = {0, 1};
    EXPECT_EQ(chains_of(surface, segments).size(), 1);
    segments[1].family = 1;
    EXPECT_EQ(chains_of(surface, segments).size(), 2);
}

TEST(Chains, OfNothingAreNone) {
    EXPECT_TRUE(chain_segments({}, {}, {}).empty());
}

TEST(Chains, RefuseWhatDoesNotFit) {
    const ChainSurface surface(shapes::grid(1, 1, 1));
    std::vector<LineSegment> segments(1);
    segments[0].face = 2;
    EXPECT_THROW(chains_of(surface, segments), UsageError);
    segments[0].face = 0;
    EXPECT_THROW(chain_segments(surface.mesh.faces, std::span(surface.neighbors).first(1), segments), UsageError);
}

TEST(FaceNeighbors, AreMutualAndShareTheEdge) {
    const TriangleMesh mesh = lumpy_sphere(2);
    const auto neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t across = neighbors[f][i];
            ASSERT_LE(across, k_max_neighbor_code);
            EXPECT_EQ(neighbors[across / 4][across % 4], 4 * f + i);
            EXPECT_EQ(mesh.faces[across / 4][across % 4], mesh.faces[f][(i + 1) % 3]);
            EXPECT_EQ(mesh.faces[across / 4][(across % 4 + 1) % 3], mesh.faces[f][i]);
        }
}

TEST(FaceNeighbors, DoNotNeedAnOrientation) {
    TriangleMesh mesh = shapes::grid(1, 1, 1);
    std::swap(mesh.faces[1][1], mesh.faces[1][2]);
    const auto neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
    EXPECT_EQ(neighbors[0][2], 4u * 1 + 2);
    EXPECT_EQ(neighbors[1][2], 4u * 0 + 2);
}

TEST(FaceNeighbors, EndAtBoundaries) {
    const TriangleMesh mesh = shapes::cylinder(1, 2, 8, 2, false);
    std::size_t free = 0;
    for (const FaceNeighbors& sides : build_face_neighbors(mesh.faces, mesh.vertices))
        free += static_cast<std::size_t>(std::count(sides.begin(), sides.end(), k_no_neighbor));
    EXPECT_EQ(free, 16);
}

TEST(FaceNeighbors, AroundACrowdedEdgeAreTheOutermostTwo) {
    // Seen along the edge, faces at these degrees; the widest gap is from the last of `ends` to the first.
    const auto expect = [](const std::vector<float>& degrees, std::array<std::size_t, 2> ends) {
        TriangleMesh mesh;
        mesh.vertices = {{0, 0, 0}, {0, 0, 1}};
        for (std::uint32_t i = 0; i < degrees.size(); ++i) {
            const float angle = degrees[i] * std::numbers::pi_v<float> / 180;
            mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0.3f});
            mesh.faces.push_back(i % 2 ? Face{1, 0, i + 2} : Face{0, 1, i + 2});
        }
        const auto neighbors = build_face_neighbors(mesh.faces, mesh.vertices);
        for (std::size_t f = 0; f < degrees.size(); ++f) {
            const std::uint32_t across = neighbors[f][0];
            if (f != ends[0] && f != ends[1]) {
                EXPECT_EQ(across, k_blocked_side);
                continue;
            }
            EXPECT_TRUE(has_neighbor(across) && (across & k_sharp_side) && (across & k_crowded_side));
            EXPECT_EQ(neighbor_face(across), f == ends[0] ? ends[1] : ends[0]);
        }
    };
    expect({0, 90, 180}, {0, 2});
    expect({100, 20, 60, 80}, {0, 1});
    expect({-170, 175, 90, 0}, {0, 3});
}

TEST(FaceNeighbors, OfDegenerateFacesAreBlockedWhereThereIsNoEdge) {
    const std::vector<Face> faces = {{0, 0, 1}, {2, 2, 2}};
    const auto neighbors = build_face_neighbors(faces, std::vector<Vec3>(3, Vec3::Zero()));
    EXPECT_EQ(neighbors[0], (FaceNeighbors{k_blocked_side, 4u * 0 + 2, 4u * 0 + 1}));  // there and back
    EXPECT_EQ(neighbors[1], (FaceNeighbors{k_blocked_side, k_blocked_side, k_blocked_side}));
}

TEST(FaceNeighbors, RefuseVerticesThatAreNotThere) {
    const std::vector<Face> faces = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_THROW(build_face_neighbors(faces, std::vector<Vec3>(3, Vec3::Zero())), MeshError);
    EXPECT_TRUE(build_face_neighbors({}, {}).empty());
}

TEST(Creases, AreWhereFacesMeetAtTheAngle) {
    // Of a prism of 12 sides: its rims at 90 degrees, its sides at 30.
    const ChainSurface surface(shapes::cylinder(1, 2, 12, 1, true));
    LineOptions options;
    const auto count = [&](float angle) {
        options.thresholds.crease_angle = angle;
        return extract_lines(surface.surface(), LineType::creases, options).size();
    };
    EXPECT_EQ(count(0.7f), 24);
    EXPECT_EQ(count(0.5f), 24 + 12);
    EXPECT_EQ(count(1.6f), 0);
}

TEST(Creases, AreNoneAtFacesWithoutArea) {
    TriangleMesh mesh = shapes::grid(1, 1, 1);
    mesh.vertices.push_back(mesh.vertices[0]);
    mesh.faces.push_back({0, 1, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    const ChainSurface surface(mesh);
    EXPECT_TRUE(surface.lines(LineType::creases).empty());
}

}  // namespace
}  // namespace exemplar
