#include <gtest/gtest.h>

#include <vector>

#include "host/curvature/learning/training.h"
#include "host/curvature/model/model.h"
#include "tests/support/bending_tube.h"
#include "tests/support/resident_bytes.h"
#include "tests/support/sanitizer.h"

namespace exemplar {
namespace {

TEST(CurvatureEvaluator, TenThousandFramesNeitherGrowNorChange) {
    const Animation tube = shapes::bending_tube();
    std::vector<FrameRef> frames;
    for (std::uint32_t f = 0; f < tube.clips[0].size(); ++f) frames.push_back({0, f});
    CurvatureTrainingReport report;
    CurvatureTraining options;
    options.augmented_poses = 0;
    for (const AttributeSet set : {AttributeSet::tensor, AttributeSet::principal}) {
        options.attributes = set;
        const CurvatureModel model = train_curvature(tube, frames, options, report);
        CurvatureEvaluator evaluator(model);
        const Clip& clip = tube.clips[1];
        TriangleMesh mesh = tube.rest;
        std::vector<std::vector<Vec3>> vertices, normals;
        std::vector<VertexCurvature> first;
        for (std::size_t f = 0; f < clip.size(); ++f) {
            vertices.push_back(frame_vertices(tube, clip, f));
            mesh.vertices = vertices.back();
            normals.push_back(vertex_normals(mesh));
            first.push_back(evaluator.evaluate(tube.rig, clip.poses[f], vertices[f], normals[f]));
        }
        const std::size_t before = test_support::resident_bytes();
        for (std::size_t i = 0; i < 10'000; ++i) {
            const std::size_t f = i % clip.size();
            const VertexCurvature& again = evaluator.evaluate(tube.rig, clip.poses[f], vertices[f], normals[f]);
            ASSERT_EQ(again.k1, first[f].k1) << "frame " << i;
            ASSERT_EQ(again.derivative, first[f].derivative) << "frame " << i;
        }
        if (!test_support::k_sanitized) {  // sanitizers keep freed memory
            EXPECT_LE(test_support::resident_bytes(), before + 1'000'000);
        }
    }
}

}  // namespace
}  // namespace exemplar
