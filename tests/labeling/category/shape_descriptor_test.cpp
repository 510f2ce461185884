#include "host/labeling/category/shape_descriptor.h"

#include <algorithm>
#include <filesystem>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/parallel.h"
#include "host/labeling/category/descriptor_cache.h"
#include "host/mesh/editing/weld.h"
#include "host/synth/shapes/shapes.h"
#include "tests/labeling/features/features_support.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using namespace feature_tests;

/// Features of faces by hand: centrality, one that falls with it, and one that does not vary.
MeshFeatures three_faces() {
    MeshFeatures features;
    features.unary.rows = 3;
    features.unary.names = {"geodesic.mean", "a", "b"};
    features.unary.values = {1, 2, 4, -1, -2, -4, 7, 7, 7};
    features.face_area = {2, 1, 1};
    return features;
}

FeatureOptions few_samples() {
    FeatureOptions options;
    options.samples = 200;
    return options;
}

/// Each triangle cut into four.
TriangleMesh subdivided(const TriangleMesh& mesh) {
    TriangleMesh fine = mesh;
    fine.faces.clear();
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        fine.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
        return static_cast<std::uint32_t>(fine.vertices.size() - 1);
    };
    for (const Face& f : mesh.faces) {
        const std::uint32_t ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
        for (const Face& part : {Face{f[0], ab, ca}, Face{ab, f[1], bc}, Face{ca, bc, f[2]}, Face{ab, bc, ca}})
            fine.faces.push_back(part);
    }
    return welded(shapes::detail::finished(std::move(fine)));
}

/// Share of the values that differ by more than `tolerance`, means and deviations in deviations of the feature.
double differing_share(const ShapeDescriptor& a, const ShapeDescriptor& b, float tolerance) {
    EXPECT_EQ(a.features, b.features);
    const std::size_t count = a.features.size();
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const float deviation = std::max(a.values[count + i % count], b.values[count + i % count]);
        const float unit = i < 2 * count ? deviation : 1;
        if (std::abs(a.values[i] - b.values[i]) > tolerance * unit + 1e-5F) ++differing;
    }
    return static_cast<double>(differing) / static_cast<double>(a.values.size());
}

TEST(ShapeDescriptor, HasMeansDeviationsAndCorrelationsByArea) {
    const ShapeDescriptor shape = compute_shape_descriptor(three_faces());
    EXPECT_EQ(shape.features, (std::vector<std::string>{"geodesic.mean", "a", "b"}));
    const float deviation = std::sqrt(1.5F);  // of 1, 1, 2, 4
    const std::vector<float> expected{2, -2, 7, deviation, deviation, 0, 1, -1, 0};
    ASSERT_EQ(shape.values.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(shape.values[i], expected[i], 1e-6F) << i;
}

TEST(ShapeDescriptor, AFaceCutInTwoIsStillOne) {
    MeshFeatures cut = three_faces();
    cut.unary.rows = 4;
    cut.unary.values = {1, 1, 2, 4, -1, -1, -2, -4, 7, 7, 7, 7};
    cut.face_area = {0.5F, 1.5F, 1, 1};
    const ShapeDescriptor whole = compute_shape_descriptor(three_faces()), parts = compute_shape_descriptor(cut);
    for (std::size_t i = 0; i < whole.values.size(); ++i) EXPECT_NEAR(whole.values[i], parts.values[i], 1e-6F) << i;
}

TEST(ShapeDescriptor, LabelsDoNotMatter) {
    MeshFeatures labeled = three_faces();
    for (const char* name : {"orientation.x", "context.geodesic.0.leg"})
        for (float& value : labeled.unary.add(name)) value = 5;
    EXPECT_EQ(compute_shape_descriptor(labeled).values, compute_shape_descriptor(three_faces()).values);
    EXPECT_EQ(compute_shape_descriptor(labeled).features, three_faces().unary.names);
}

TEST(ShapeDescriptor, WithoutAreaAllFacesCount) {
    MeshFeatures flat = three_faces();
    flat.face_area = {0, 0, 0};
    EXPECT_NEAR(compute_shape_descriptor(flat).values[0], 7.0F / 3, 1e-6F);
}

TEST(ShapeDescriptor, WhatCannotBeDescribedIsRefused) {
    EXPECT_THROW(compute_shape_descriptor(MeshFeatures()), UsageError);
    MeshFeatures other = three_faces();
    other.unary.names[0] = "geodesic.median";
    EXPECT_THROW(compute_shape_descriptor(other), UsageError);
    other = three_faces();
    other.face_area.pop_back();
    EXPECT_THROW(compute_shape_descriptor(other), UsageError);
}

TEST(ShapeDescriptor, DoesNotDependOnPlaceSizeAndTurn) {
    const TriangleMesh mesh = lopsided_torus(30, 18);
    TriangleMesh moved = shapes::rotated(mesh, shapes::random_rotation(3));
    moved = shapes::translated(shapes::scaled(std::move(moved), 37.0F), Vec3(10, -20, 5));
    const ShapeDescriptor here = compute_shape_descriptor(compute_features(mesh, few_samples()));
    const ShapeDescriptor there = compute_shape_descriptor(compute_features(moved, few_samples()));
    EXPECT_EQ(here.values.size(), 3U * 678U);
    EXPECT_LT(differing_share(here, there, 0.02F), 0.01);
}

TEST(ShapeDescriptor, DependsLittleOnTheMeshing) {
    const TriangleMesh mesh = make_shape("cup", 4, 2000).mesh;
    const ShapeDescriptor coarse = compute_shape_descriptor(compute_features(mesh));
    const ShapeDescriptor fine = compute_shape_descriptor(compute_features(subdivided(mesh)));
    const ShapeDescriptor other = compute_shape_descriptor(compute_features(make_shape("human", 4, 2000).mesh));
    EXPECT_LT(differing_share(coarse, fine, 0.2F), 0.05);
    EXPECT_GT(differing_share(coarse, other, 0.2F), 0.5);
}

TEST(ShapeDescriptor, IsFiniteWhateverTheMesh) {
    TriangleMesh needle = shapes::box(1, 1, 1, 2);
    for (Vec3& p : needle.vertices) p = Vec3(p.x(), 1e-7F * p.y(), 0);
    TriangleMesh triangle;
    triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.faces = {{0, 1, 2}};
    TriangleMesh point = triangle;
    point.vertices = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    const TriangleMesh apart =
        shapes::joined(shapes::icosphere(1, 1), shapes::translated(shapes::icosphere(1, 1), Vec3(9, 0, 0)));
    for (const TriangleMesh& mesh : {needle, triangle, point, apart}) {
        const ShapeDescriptor shape = compute_shape_descriptor(compute_features(mesh, few_samples()));
        EXPECT_TRUE(std::ranges::all_of(shape.values, [](float x) { return std::isfinite(x); })) << mesh.face_count();
    }
}

TEST(ShapeDescriptor, DoesNotDependOnThreads) {
    const MeshFeatures features = compute_features(lopsided_torus(20, 12), few_samples());
    const ShapeDescriptor all = compute_shape_descriptor(features);
    const ThreadLimit limit(1);
    EXPECT_EQ(compute_shape_descriptor(features).values, all.values);
}

TEST(ShapeDescriptorCache, KeepsDescriptorsNotFeatures) {
    namespace fs = std::filesystem;
    const TemporaryFolder folder;
    const TriangleMesh mesh = lopsided_torus(12, 8);
    const ShapeDescriptor first = cached_shape_descriptor(mesh, few_samples(), folder.path());
    EXPECT_EQ(first.values, cached_shape_descriptor(mesh, few_samples(), {}).values);
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder.path())) entries.push_back(entry.path());
    ASSERT_EQ(entries.size(), 1U);
    EXPECT_LT(fs::file_size(entries[0]), 100'000U);
    EXPECT_EQ(cached_shape_descriptor(mesh, few_samples(), folder.path()).values, first.values);

    const std::string bytes = read_file(entries[0]);
    write_file_atomically(entries[0], [&](std::ostream& out) { out << bytes.substr(0, bytes.size() / 2); });
    EXPECT_EQ(cached_shape_descriptor(mesh, few_samples(), folder.path()).values, first.values);
    EXPECT_EQ(read_file(entries[0]), bytes) << "a damaged entry is made again";
}

}  // namespace
}  // namespace exemplar
