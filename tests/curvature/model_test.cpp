#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/random.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"
#include "host/curvature/model/tiling.h"
#include "host/data/safetensors.h"
#include "tests/support/bending_tube.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using ::testing::HasSubstr;

const Animation& tube() {
    static const Animation animation = shapes::bending_tube();
    return animation;
}

std::vector<FrameRef> frames_of(const Animation& animation, std::uint32_t clip) {
    std::vector<FrameRef> frames;
    for (std::uint32_t f = 0; f < animation.clips[clip].size(); ++f) frames.push_back({clip, f});
    return frames;
}

CurvatureModel trained_model(const Animation& animation, const CurvatureTraining& options) {
    CurvatureTrainingReport report;
    return train_curvature(animation, frames_of(animation, 0), options, report);
}

/// RMS errors of k1 and of C111, over the zero-order's.
std::pair<double, double> relative_errors(const CurvatureModel& model, const Animation& animation, std::uint32_t clip) {
    const CurvatureEvaluation result = evaluate_curvature(model, animation, frames_of(animation, clip));
    return {result.attributes[0].rms / result.attributes[0].zero_order_rms,
            result.attributes[3].rms / result.attributes[3].zero_order_rms};
}

struct TrainingCase {
    Learner learner;
    AttributeSet attributes;
    bool independent;
    double limit;  ///< of the error of k1 over the zero-order's; quadratics of the root's turns fit less
};
class TrainingTest : public ::testing::TestWithParam<TrainingCase> {};

TEST_P(TrainingTest, PredictsABendItHasNotSeen) {
    CurvatureTraining options;
    options.learner = GetParam().learner;
    options.attributes = GetParam().attributes;
    options.independent = GetParam().independent;
    const auto [curvature, derivative] = relative_errors(trained_model(tube(), options), tube(), 1);
    EXPECT_LT(curvature, GetParam().limit);
    EXPECT_LT(derivative, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Ways, TrainingTest,
                         ::testing::Values(TrainingCase{Learner::additive, AttributeSet::tensor, true, 0.15},
                                           TrainingCase{Learner::additive, AttributeSet::principal, true, 0.15},
                                           TrainingCase{Learner::averaged, AttributeSet::tensor, true, 0.3},
                                           TrainingCase{Learner::averaged, AttributeSet::principal, false, 0.3},
                                           TrainingCase{Learner::global, AttributeSet::tensor, false, 0.3}),
                         [](const auto& instance) {
                             return std::string(name_of(instance.param.learner)) +
                                    (instance.param.attributes == AttributeSet::tensor ? "_tensor" : "_principal") +
                                    (instance.param.independent ? "_ica" : "_pca");
                         });

TEST(Training, OfEqualSeedsGivesEqualFiles) {
    const TemporaryFolder folder;
    const std::filesystem::path first = folder.path() / "a.safetensors", second = folder.path() / "b.safetensors";
    save_curvature_model(first, trained_model(tube(), {}));
    save_curvature_model(second, trained_model(tube(), {}));
    EXPECT_EQ(read_file(first), read_file(second));
}

TEST(Training, NeedsPosesThatDiffer) {
    CurvatureTrainingReport report;
    const std::vector<FrameRef> few(k_min_poses - 1, FrameRef{0, 0}), same(k_min_poses, FrameRef{0, 0});
    CurvatureTraining no_others;
    no_others.augmented_poses = 0;
    try {
        train_curvature(tube(), few, {}, report);
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("at least 20"));
    }
    EXPECT_THROW(train_curvature(tube(), same, no_others, report), UsageError);
}

TEST(Training, SparsityMakesModelsSmallerAndErrorsHardlyLarger) {
    CurvatureTraining dense, sparse;
    dense.dropped_variance = 0;
    sparse.dropped_variance = 0.02;
    const CurvatureModel large = trained_model(tube(), dense), small = trained_model(tube(), sparse);
    EXPECT_LT(small.tiles.entry.size(), large.tiles.entry.size());
    EXPECT_LT(relative_errors(small, tube(), 1).first, relative_errors(large, tube(), 1).first + 0.15);
}

TEST(CurvatureModel, FilesHoldTheWholeModel) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "m.safetensors";
    const CurvatureModel model = trained_model(tube(), {});
    save_curvature_model(path, model);
    const CurvatureModel back = load_curvature_model(path);
    save_curvature_model(folder.path() / "again.safetensors", back);
    EXPECT_EQ(read_file(path), read_file(folder.path() / "again.safetensors"));

    SnapshotReader reader(tube(), model.segments, model.truth);
    CurvatureEvaluator a(model), b(back);
    const SurfaceSnapshot snapshot = reader.read({1, 4});
    const Pose& pose = tube().clips[1].poses[4];
    const VertexCurvature& from_memory = a.evaluate(tube().rig, pose, snapshot.vertices, snapshot.normals);
    const VertexCurvature& from_file = b.evaluate(tube().rig, pose, snapshot.vertices, snapshot.normals);
    EXPECT_EQ(from_memory.k1, from_file.k1);
    EXPECT_EQ(from_memory.derivative, from_file.derivative);
}

TEST(CurvatureModel, OfAnotherSurfaceIsRefused) {
    const CurvatureModel model = trained_model(tube(), {.learner = Learner::additive});
    EXPECT_NO_THROW(require_compatible(model, tube()));
    const Animation finer = shapes::tube_rig(40, 16);
    EXPECT_THROW(require_compatible(model, finer), ModelError);
    Animation renamed = tube();
    renamed.rig.nodes[2].name = "knee";
    EXPECT_THROW(require_compatible(model, renamed), ModelError);
    Animation flipped = tube();
    std::swap(flipped.rest.faces[3][0], flipped.rest.faces[3][1]);
    EXPECT_THROW(require_compatible(model, flipped), ModelError);
}

TEST(CurvatureModel, DamagedFilesAreRefused) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "m.safetensors", damaged = folder.path() / "d.safetensors";
    save_curvature_model(path, trained_model(tube(), {.learner = Learner::additive}));
    const auto refused = [&](auto&& change) {
        TensorFile file = read_safetensors(path);
        change(file);
        write_safetensors(damaged, file);
        EXPECT_THROW(load_curvature_model(damaged), ModelError);
    };
    refused([](TensorFile& f) { f.metadata["kind"] = "exemplar mesh labeling"; });
    refused([](TensorFile& f) { f.metadata["format_version"] = "99"; });
    refused([](TensorFile& f) { f.metadata["model"] = "{}"; });
    refused([](TensorFile& f) { f.metadata["model"] = "["; });
    const auto change_word = [&](const char* name, std::size_t at, std::uint32_t value) {
        refused([&](TensorFile& f) {
            auto values = f.get<std::uint32_t>(name);
            values[at] = value;
            f.add(name, f.tensors.at(name).shape, values);
        });
    };
    change_word("tiles.vertex", 3, 1u << 30);
    change_word("tiles.segment", 0, 1);
    change_word("tiles.entry_begin", 2, 1u << 30);
    change_word("regression.monomials", 4, 1000);
    change_word("regression.components", 0, 1u << 31);
    change_word("regression.components", 2, 0xFFFFFFF0u);
    change_word("tiles.neighbor", 5, 1u << 30);
    refused([](TensorFile& f) {
        auto values = f.get<float>("regression.coefficients");
        values[0] = std::numeric_limits<float>::quiet_NaN();
        f.add("regression.coefficients", {values.size()}, values);
    });
    change_word("tiles.entry", 0, 0x3F80FFFFu);  // the last component there can be
    change_word("tiles.entry", 0, 0x7F800000u);  // an infinite step
    refused([](TensorFile& f) {
        auto values = f.get<Half>("tiles.mean");
        values[0].bits = 0x7C00;
        f.add("tiles.mean", f.tensors.at("tiles.mean").shape, values);
    });
    for (const auto& [name, tensor] : read_safetensors(path).tensors) {
        const std::string key = name;
        refused([&](TensorFile& f) { f.tensors.erase(key); });
    }
    std::ofstream(damaged) << "no model";
    EXPECT_THROW(load_curvature_model(damaged), ModelError);
}

TEST(Tiling, GivesWhatTheBasesGive) {
    // 37 vertices in two segments, two bases of the first attribute that overlap.
    Random random(7);
    AttributeFrames frames;
    std::vector<Vec3> rest;
    for (std::size_t v = 0; v < 37; ++v) {
        frames.neighbor.push_back(0);
        frames.segment.push_back(v < 20 ? 0 : 1);
        frames.reference_normal.push_back(Vec3::UnitX());
        rest.emplace_back(float(random.uniform()), float(random.uniform()), float(random.uniform()));
    }
    Eigen::MatrixXf means = Eigen::MatrixXf::Random(7, 37);
    std::vector<VertexBasis> bases(2);
    for (std::uint32_t v = 0; v < 25; ++v) bases[0].vertices.push_back(v);
    for (std::uint32_t v = 10; v < 37; ++v) bases[1].vertices.push_back(v);
    bases[0].basis = Eigen::MatrixXf::Random(25, 3);
    bases[1].basis = Eigen::MatrixXf::Random(27, 2);
    bases[1].first_component = 3;
    const BasisTiles tiles = make_tiles(frames, rest, means, bases, {});
    EXPECT_EQ(tiles.tile_count(), 4u);
    const std::vector<float> z = {0.5f, -1, 2, 0.25f, 1};
    std::vector<float> attributes(7 * 37);
    reproject(tiles, z, attributes);
    // Bases are at most one, so that half a step is at most a 254th, and a 128th of it.
    const float rounding = (1.0f / 254) * (129.0f / 128) * (0.5f + 1 + 2 + 0.25f + 1) + 1e-3f;
    for (std::size_t v = 0; v < 37; ++v) {
        float expected = means(0, Eigen::Index(v));
        if (v < 25)
            expected += bases[0].basis.row(Eigen::Index(v)).dot(Eigen::Map<const Eigen::RowVectorXf>(z.data(), 3));
        if (v >= 10)
            expected +=
                bases[1].basis.row(Eigen::Index(v - 10)).dot(Eigen::Map<const Eigen::RowVectorXf>(z.data() + 3, 2));
        EXPECT_NEAR(attributes[v], expected, rounding);
        EXPECT_NEAR(attributes[37 + v], means(1, Eigen::Index(v)), 1e-3);
    }
}

TEST(Tiling, TakesTheFinestStepsThatReach) {
    for (const float least : {0.0f, 1e-30f, 0.3f, 1.0f, 1.00001f, 255.0f / 128, 3e30f}) {
        const std::uint32_t entry = BasisTiles::make_entry(54321, least);
        EXPECT_EQ(BasisTiles::component_of(entry), 54321u);
        EXPECT_GE(BasisTiles::step_of(entry), least);
        EXPECT_LE(BasisTiles::step_of(entry), least * (129.0f / 128));
    }
}

TEST(Tiling, DropsTheWeakestFirstAndNoMoreThanAllowed) {
    AttributeFrames frames;
    std::vector<Vec3> rest;
    for (std::size_t v = 0; v < 64; ++v) {
        frames.neighbor.push_back(0);
        frames.segment.push_back(0);
        frames.reference_normal.push_back(Vec3::UnitX());
        rest.emplace_back(float(v), 0.0f, 0.0f);
    }
    VertexBasis basis;
    basis.basis.resize(64, 1);
    for (std::uint32_t v = 0; v < 64; ++v) {
        basis.vertices.push_back(v);
        basis.basis(v, 0) = v < 16 ? 10.0f : 1.0f;  // a strong tile, three weak ones of one percent each
    }
    const Eigen::MatrixXf means = Eigen::MatrixXf::Zero(7, 64);
    EXPECT_EQ(make_tiles(frames, rest, means, {basis}, {}).entry.size(), 4u);
    EXPECT_EQ(make_tiles(frames, rest, means, {basis}, {.dropped_variance = 0.05}).entry.size(), 1u);
    EXPECT_EQ(make_tiles(frames, rest, means, {basis}, {.dropped_variance = 0.001}).entry.size(), 4u);
}

// One pass with decoding gives what re-projection and decoding give apart.
TEST(Evaluator, GivesWhatReprojectionAndDecodingGive) {
    for (const AttributeSet set : {AttributeSet::principal, AttributeSet::tensor}) {
        CurvatureTraining options;
        options.attributes = set;
        const CurvatureModel model = trained_model(tube(), options);
        SnapshotReader reader(tube(), model.segments, model.truth);
        const SurfaceSnapshot snapshot = reader.read({1, 7});
        CurvatureEvaluator evaluator(model);
        const VertexCurvature& fast =
            evaluator.evaluate(tube().rig, tube().clips[1].poses[7], snapshot.vertices, snapshot.normals);

        AttributeFrames frames;
        frames.set = set;
        frames.segment.resize(model.vertex_count);
        frames.neighbor.resize(model.vertex_count);
        frames.reference_normal.resize(model.vertex_count);
        for (std::size_t i = 0; i < model.tiles.vertex.size(); ++i) {
            const std::size_t tile = i / BasisTiles::k_lanes, lane = i % BasisTiles::k_lanes;
            const std::uint32_t v = model.tiles.vertex[i];
            frames.segment[v] = model.tiles.segment[tile];
            if (set == AttributeSet::tensor) frames.neighbor[v] = model.tiles.neighbor[i];
            for (std::size_t k = 0; k < 3 && set == AttributeSet::principal; ++k)
                frames.reference_normal[v][Eigen::Index(k)] =
                    from_half(model.tiles.reference[(3 * tile + k) * BasisTiles::k_lanes + lane]);
        }
        std::vector<float> attributes(attribute_count(set) * model.vertex_count);
        reproject(model.tiles, evaluator.components(), attributes);
        VertexCurvature plain;
        frames.decode(attributes, snapshot.surface(), plain);
        for (std::size_t v = 0; v < model.vertex_count; ++v) {
            EXPECT_NEAR(fast.k1[v], plain.k1[v], 1e-4);
            EXPECT_NEAR(fast.k2[v], plain.k2[v], 1e-4);
            EXPECT_NEAR((fast.e1[v] - plain.e1[v]).norm(), 0, 2e-3);
            EXPECT_NEAR((fast.e2[v] - plain.e2[v]).norm(), 0, 2e-3);
            for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(fast.derivative[v][k], plain.derivative[v][k], 2e-3);
        }
    }
}

}  // namespace
}  // namespace exemplar
