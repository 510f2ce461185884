#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"
#include "host/curvature/model/tiling.h"
#include "host/data/safetensors.h"
#include "tests/support/bending_tube.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

/// A sheet in waves of two directions that come and go; the second clip goes through them in another way.
Animation waving_sheet() {
    Animation animation;
    animation.name = "sheet";
    animation.kind = AnimationKind::sequence;
    animation.rest = shapes::grid(20, 20, 1);
    for (const float pace : {1.0f, 1.7f}) {
        Clip clip;
        clip.name = "waves";
        for (int i = 0; i < 40; ++i) {
            const float a = std::sin(0.7f * pace * float(i)), b = std::cos(0.45f * pace * float(i) + pace);
            clip.frames.push_back(animation.rest.vertices);
            for (Vec3& p : clip.frames.back())
                p.z() = 0.05f * (a * std::sin(5 * p.x() + 2 * p.y()) + b * std::cos(6 * p.y()));
        }
        animation.clips.push_back(clip);
    }
    return animation;
}

std::vector<FrameRef> frames_of_clip(const Animation& animation, std::uint32_t clip) {
    std::vector<FrameRef> frames;
    for (std::uint32_t f = 0; f < animation.clips[clip].size(); ++f) frames.push_back({clip, f});
    return frames;
}

CurvatureModel trained_locally(const Animation& animation, CurvatureTraining options = {}) {
    options.learner = Learner::local;
    CurvatureTrainingReport report;
    return train_curvature(animation, frames_of_clip(animation, 0), options, report);
}

TEST(LocalLearner, PredictsMotionItHasNotSeen) {
    const Animation sheet = waving_sheet();
    for (const AttributeSet set : {AttributeSet::tensor, AttributeSet::principal}) {
        CurvatureTraining options;
        options.attributes = set;
        const CurvatureEvaluation result =
            evaluate_curvature(trained_locally(sheet, options), sheet, frames_of_clip(sheet, 1));
        // The principal directions of a sheet that is flat now and then jump, whichever way they are learned.
        const double most = set == AttributeSet::tensor ? 0.1 : 0.5;
        EXPECT_LT(result.attributes[0].rms, most * result.attributes[0].zero_order_rms);
        if (set == AttributeSet::tensor) {
            EXPECT_LT(result.attributes[3].rms, 0.4 * result.attributes[3].zero_order_rms);
        }
    }
}

TEST(LocalLearner, RefusesMoreComponentsThanAModelNumbersBeforeItMeasures) {
    const Animation sheet = waving_sheet();
    CurvatureTraining options;
    options.learner = Learner::local;
    options.sequence.max_inputs = k_max_components;
    CurvatureTrainingReport report;
    EXPECT_THROW(train_curvature(sheet, frames_of_clip(sheet, 0), options, report), UsageError);
    EXPECT_EQ(report.seconds_truth, 0);
}

TEST(LocalLearner, IsEvaluatedAsItsStateIsRead) {
    const Animation sheet = waving_sheet();
    CurvatureTraining options;
    for (const std::size_t inputs : {3u, 16u, 21u}) {
        options.sequence.max_inputs = inputs;
        const CurvatureModel model = trained_locally(sheet, options);
        EXPECT_TRUE(model.regression.is_identity());
        CurvatureEvaluator evaluator(model);
        TriangleMesh mesh = sheet.rest;
        mesh.vertices = sheet.clips[1].frames[7];
        const std::vector<Vec3> normals = vertex_normals(mesh);
        evaluator.evaluate(mesh.vertices, normals);
        std::vector<Eigen::Matrix3f> rotations;
        std::vector<float> x(model.state.input_count), features(model.regression.feature_count()), z(x.size());
        model.segments.rotations_of_sequence(mesh.vertices, rotations);
        model.state.read_surface(mesh.vertices, normals, rotations, x);
        const PoseRange::Farthest farthest = model.range.prepare(model.state, x);
        model.regression.evaluate(x, features, z);
        ASSERT_EQ(evaluator.components().size(), z.size());
        for (std::size_t i = 0; i < z.size(); ++i) EXPECT_NEAR(evaluator.components()[i], z[i], 1e-4f);
        EXPECT_EQ(evaluator.farthest().control, farthest.control);
        EXPECT_NEAR(evaluator.farthest().distance, farthest.distance, 1e-4f * farthest.distance);
    }
}

TEST(LocalLearner, DoesNotCareWhereTheSurfaceIs) {
    const Animation sheet = waving_sheet();
    const CurvatureModel model = trained_locally(sheet);
    CurvatureEvaluator evaluator(model);
    TriangleMesh mesh = sheet.rest;
    mesh.vertices = sheet.clips[1].frames[7];
    const VertexCurvature before = evaluator.evaluate(mesh.vertices, vertex_normals(mesh));
    const Eigen::AngleAxisf turn(2.2f, Vec3(1, 2, -1).normalized());
    for (Vec3& p : mesh.vertices) p = turn * p + Vec3(3, -2, 1);
    const VertexCurvature after = evaluator.evaluate(mesh.vertices, vertex_normals(mesh));
    for (std::size_t v = 0; v < before.k1.size(); ++v) {
        EXPECT_NEAR(after.k1[v], before.k1[v], 2e-2f);
        EXPECT_NEAR(std::abs(after.e1[v].dot(turn * before.e1[v])), 1, before.k1[v] - before.k2[v] > 0.3f ? 1e-2 : 1);
    }
}

TEST(LocalLearner, FilesHoldTheWholeModel) {
    const TemporaryFolder folder;
    const Animation sheet = waving_sheet();
    const CurvatureModel model = trained_locally(sheet);
    const std::filesystem::path path = folder.path() / "m.safetensors", again = folder.path() / "again.safetensors";
    save_curvature_model(path, model);
    const CurvatureModel back = load_curvature_model(path);
    save_curvature_model(again, back);
    EXPECT_EQ(read_file(path), read_file(again));
    const CurvatureModel twin = trained_locally(sheet);
    save_curvature_model(again, twin);
    EXPECT_EQ(read_file(path), read_file(again));
    TriangleMesh mesh = sheet.rest;
    mesh.vertices = sheet.clips[1].frames[3];
    CurvatureEvaluator a(model), b(back);
    EXPECT_EQ(a.evaluate(mesh.vertices, vertex_normals(mesh)).k1, b.evaluate(mesh.vertices, vertex_normals(mesh)).k1);
}

TEST(LocalLearner, DamagedFilesAreRefused) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "m.safetensors", damaged = folder.path() / "d.safetensors";
    save_curvature_model(path, trained_locally(waving_sheet()));
    const auto refused = [&](auto&& change) {
        TensorFile file = read_safetensors(path);
        change(file);
        write_safetensors(damaged, file);
        EXPECT_THROW(load_curvature_model(damaged), ModelError);
    };
    const auto change_word = [&](const char* name, std::size_t at, std::uint32_t value) {
        refused([&](TensorFile& f) {
            auto values = f.get<std::uint32_t>(name);
            values[at] = value;
            f.add(name, f.tensors.at(name).shape, values);
        });
    };
    change_word("state.local_vertex", 5, 1u << 30);
    change_word("state.local_begin", 1, 1u << 30);
    change_word("state.local_begin", 0, 1);
    const auto change_float = [&](const char* name, float value) {
        refused([&](TensorFile& f) {
            auto values = f.get<float>(name);
            values[0] = value;
            f.add(name, f.tensors.at(name).shape, values);
        });
    };
    change_float("state.local_unit", 0);
    change_float("state.local_mean", std::numeric_limits<float>::quiet_NaN());
    const auto cut = [&](const char* name) {
        refused([&](TensorFile& f) {
            auto values = f.get<float>(name);
            values.pop_back();
            f.add(name, {values.size()}, values);
        });
    };
    cut("state.local_mean");
    refused([](TensorFile& f) {
        auto values = f.get<Half>("state.local_map");
        values.pop_back();
        f.add("state.local_map", {values.size()}, values);
    });
}

TEST(LocalLearner, IsForSurfacesThatBend) {
    Animation still = waving_sheet();
    for (auto& frame : still.clips[0].frames) frame = still.rest.vertices;
    EXPECT_THROW(trained_locally(still), UsageError);
}

TEST(LocalLearner, RigsAreReadByTheirSurface) {
    const TemporaryFolder folder;
    const Animation tube = shapes::bending_tube();
    for (const AttributeSet set : {AttributeSet::tensor, AttributeSet::principal}) {
        CurvatureTraining options;
        options.attributes = set;
        const CurvatureModel model = trained_locally(tube, options);
        const CurvatureEvaluation result = evaluate_curvature(model, tube, frames_of_clip(tube, 1));
        EXPECT_LT(result.attributes[0].rms, 0.25 * result.attributes[0].zero_order_rms);
        EXPECT_LT(result.lines[0].misclassified, 0.25 * result.lines[0].zero_order);
        const std::filesystem::path path = folder.path() / "m.safetensors";
        save_curvature_model(path, model);
        const CurvatureModel back = load_curvature_model(path);
        EXPECT_NO_THROW(require_compatible(back, tube));
        TriangleMesh mesh = tube.rest;
        mesh.vertices = frame_vertices(tube, tube.clips[1], 5);
        const std::vector<Vec3> normals = vertex_normals(mesh);
        CurvatureEvaluator of_pose(back), of_surface(model);
        EXPECT_EQ(of_pose.evaluate(tube.rig, tube.clips[1].poses[5], mesh.vertices, normals).k1,
                  of_surface.evaluate(mesh.vertices, normals).k1);
    }
}

// Augmented poses bend the tube farther and otherwise than its frames; what is compared with is the mean of those.
TEST(LocalLearner, TheMeanIsThatOfTheFrames) {
    const Animation tube = shapes::bending_tube();
    const std::vector<FrameRef> frames = frames_of_clip(tube, 0);
    const CurvatureModel model = trained_locally(tube);
    std::vector<float> mean(attribute_count(AttributeSet::tensor) * model.vertex_count);
    reproject(model.tiles, std::vector<float>(model.regression.components.size(), 0.0f), mean);
    AttributeFrames attribute_frames;
    attribute_frames.neighbor.resize(model.vertex_count);
    for (std::size_t i = 0; i < model.tiles.vertex.size(); ++i)
        attribute_frames.neighbor[model.tiles.vertex[i]] = model.tiles.neighbor[i];
    std::vector<float> values(mean.size());
    std::vector<double> sum(mean.size(), 0);
    for (const SurfaceSnapshot& snapshot : read_snapshots(tube, {}, frames, model.truth)) {
        attribute_frames.encode(snapshot.curvature, snapshot.surface(), values);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i] / double(frames.size());
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const float scale = model.tiles.scale[i / model.vertex_count];
        EXPECT_NEAR(mean[i], sum[i], 1e-3 * std::abs(sum[i]) + 1e-3 * 1024 * scale);
    }
}

}  // namespace
}  // namespace exemplar
