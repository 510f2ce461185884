#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "gpu/curvature/learned_curvature.h"
#include "gpu/curvature/normals.h"
#include "gpu/curvature/poser.h"
#include "gpu/runtime/errors.h"
#include "host/core/errors.h"
#include "host/curvature/model_builder.h"
#include "host/curvature/tiling.h"
#include "host/curvature/training.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"
#include "tests/parity/tensors.h"
#include "tests/support/bending_tube.h"

// Both read the same halves and round sums of a few dozen products to single precision, in another order each: relative
// to themselves and one, tensors agree to a few 1e-6. Where edges stand steep, or normals are far from those in
// training, the tangent frame divides by as little as 0.05.
namespace exemplar {
namespace {

using shared::vec4;
using testing::derivative_in_space;
using testing::distance;
using testing::download;
using testing::form_in_space;
using testing::random_pose;
using testing::random_vec3;
using testing::resident_bytes;
using testing::same_bits;
using testing::shared_device;
using testing::size_of;

constexpr double k_tolerance = 1e-5;

void expect_near(const VertexCurvature& actual, const VertexCurvature& expected, double tolerance = k_tolerance) {
    ASSERT_EQ(actual.k1.size(), expected.k1.size());
    for (std::size_t v = 0; v < expected.k1.size(); ++v) {
        ASSERT_GE(actual.k1[v], actual.k2[v]) << "vertex " << v;
        const testing::Tensor2 form = form_in_space(expected, v);
        ASSERT_LE((form_in_space(actual, v) - form).norm(), tolerance * (1 + form.norm()))
            << "vertex " << v << ": curvatures " << actual.k1[v] << " and " << actual.k2[v] << " instead of "
            << expected.k1[v] << " and " << expected.k2[v];
        const testing::Tensor3 derivative = derivative_in_space(expected, v);
        ASSERT_LE(distance(derivative_in_space(actual, v), derivative), tolerance * (1 + size_of(derivative)))
            << "vertex " << v;
    }
}

struct Shape {
    std::size_t vertices = 200;
    AttributeSet set = AttributeSet::tensor;
    std::size_t segments = 3;  // of principal attributes
    std::size_t blocks = 10;   // of components that share their features
    std::size_t neurons = 0;
    std::size_t most_components = 5;  // of a block and attribute
};

struct Surface {
    std::vector<Vec3> vertices, normals;
};

// A model without sense, of a rig of ten bones.
class RandomModel {
  public:
    RandomModel(const Shape& shape, std::uint64_t seed) : random_(seed) {
        rig = testing::random_rig(shape.vertices, 10, 2, random_);
        model.kind = AnimationKind::skeleton;
        model.vertex_count = shape.vertices;
        add_state();
        if (shape.set == AttributeSet::principal) add_segments(shape.segments);
        add_frames(shape);
        PredictorBuilder builder(model.state.input_count);
        for (std::size_t b = 0; b < shape.blocks; ++b) add_block(shape, builder);
        if (shape.neurons > 0) add_neurons(shape, builder);
        model.regression = builder.regression();
        Eigen::MatrixXf means = random_matrix(attribute_count(shape.set), shape.vertices);
        // Keeps e1 from vanishing, where its direction would be rounding alone.
        if (shape.set == AttributeSet::principal) means.row(2).array() += 4.0f;
        model.tiles = make_tiles(frames_, points_, means, builder.bases(), {});
    }

    Pose pose() { return random_pose(rig, random_); }

    // Random points, with unit normals about where the model saw them, or anywhere.
    Surface surface(const Pose& pose, bool anywhere) {
        Surface result;
        for (std::size_t v = 0; v < points_.size(); ++v) result.vertices.push_back(random_vec3(random_));
        const std::vector<Vec3> expected = expected_normals(pose, result.vertices);
        for (const Vec3& normal : expected)
            result.normals.push_back(
                (anywhere ? random_vec3(random_) : Vec3(normal + 0.2f * random_vec3(random_))).normalized());
        return result;
    }
    // Normals opposite to where the model saw them, along the edge that should be a tangent, or of no edge.
    Surface degenerate_surface(const Pose& pose) {
        Surface result = surface(pose, false);
        result.normals = expected_normals(pose, result.vertices);
        for (std::size_t v = 0; v < points_.size(); ++v)
            if (frames_.set == AttributeSet::principal)
                result.normals[v] *= -1.0f;
            else if (v % 3 == 0)
                result.vertices[frames_.neighbor[v]] = result.vertices[v];
            else if (const Vec3 edge = edge_at(result.vertices, v); edge.norm() > 0)
                result.normals[v] = edge.normalized();
        return result;
    }

    Rig rig;
    CurvatureModel model;

  private:
    Eigen::MatrixXf random_matrix(std::size_t rows, std::size_t columns) {
        return Eigen::MatrixXf::NullaryExpr(Eigen::Index(rows), Eigen::Index(columns),
                                            [&] { return float(random_.normal()); });
    }

    Vec3 edge_at(const std::vector<Vec3>& vertices, std::size_t v) const {
        return vertices[frames_.neighbor[v]] - vertices[v];
    }

    // Reference normals in the world; of tensors, some that edges are orthogonal to.
    std::vector<Vec3> expected_normals(const Pose& pose, const std::vector<Vec3>& vertices) const {
        std::vector<Vec3> normals;
        std::vector<Eigen::Matrix3f> rotations;
        if (model.segments.count() != 0) model.segments.rotations_of_rig(bone_transforms(rig, pose), rotations);
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (frames_.set == AttributeSet::principal)
                normals.emplace_back(rotations[frames_.segment[v]] * frames_.reference_normal[v]);
            else if (const Vec3 edge = edge_at(vertices, v); edge.norm() > 0)
                normals.push_back(any_frame(edge.normalized()).tangent);
            else
                normals.push_back(Vec3::UnitY());
        return normals;
    }

    void add_state() {
        model.state.kind = AnimationKind::skeleton;
        for (std::uint32_t n = 0; n < rig.nodes.size(); n += 2) {
            model.state.nodes.push_back(n);
            model.state.reference.push_back(testing::random_transform(random_).rotation);
            model.state.controls.push_back({rig.nodes[n].name, std::uint32_t(model.state.input_count), 3});
            model.state.input_count += 3;
        }
        add_range();
    }

    // Of so few poses that about a third of the controls of others are beyond it.
    void add_range() {
        Eigen::MatrixXf states(6, Eigen::Index(model.state.input_count));
        std::vector<float> x(model.state.input_count);
        for (Eigen::Index i = 0; i < states.rows(); ++i) {
            model.state.read_pose(pose(), x);
            states.row(i) = Eigen::Map<const Eigen::RowVectorXf>(x.data(), states.cols());
        }
        model.range = make_pose_range(model.state, states);
    }

    void add_segments(std::size_t count) {
        model.segments.influence_begin = {0};
        for (std::size_t s = 0; s < count; ++s) {
            const float weight = float(random_.uniform(0.3, 0.7));
            model.segments.influences.push_back({std::uint32_t(random_.index(5)), weight});
            model.segments.influences.push_back({std::uint32_t(5 + random_.index(5)), 1 - weight});
            model.segments.influence_begin.push_back(std::uint32_t(2 * s + 2));
        }
    }

    void add_frames(const Shape& shape) {
        frames_.set = shape.set;
        for (std::size_t v = 0; v < shape.vertices; ++v) {
            points_.push_back(random_vec3(random_));
            if (shape.set == AttributeSet::tensor) {
                frames_.neighbor.push_back(std::uint32_t(random_.index(shape.vertices)));
                continue;
            }
            frames_.segment.push_back(std::uint32_t(v < shape.segments ? v : random_.index(shape.segments)));
            frames_.reference_normal.push_back(random_vec3(random_).normalized());
        }
    }

    // Bases over a part of the vertices, for about three of four attributes.
    void add_bases(const Shape& shape, std::uint32_t first, std::size_t features, PredictorBuilder& builder) {
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t v = 0; v < shape.vertices; ++v)
            if (random_.uniform() < 0.4) vertices.push_back(v);
        for (std::size_t a = 0; a < attribute_count(shape.set); ++a) {
            if (random_.uniform() < 0.25) continue;
            const std::size_t components = 1 + random_.index(shape.most_components);
            builder.add_basis(a, vertices, 0.3f * random_matrix(vertices.size(), components), first,
                              0.3f * random_matrix(components, features));
        }
    }

    void add_block(const Shape& shape, PredictorBuilder& builder) {
        const auto inputs = std::uint32_t(model.state.input_count);
        std::vector<Monomial> monomials{{inputs, inputs, inputs}};
        const std::size_t count = random_.index(20);
        const auto input = [&] { return std::uint32_t(random_.index(inputs + 1)); };
        for (std::size_t m = 0; m < count; ++m) monomials.push_back({input(), input(), input()});
        const std::uint32_t first = builder.add_monomials(monomials);
        add_bases(shape, first, monomials.size(), builder);
    }

    void add_neurons(const Shape& shape, PredictorBuilder& builder) {
        const Eigen::VectorXf bias = random_matrix(shape.neurons, 1);
        const std::uint32_t first = builder.add_neurons(random_matrix(shape.neurons, model.state.input_count), bias);
        add_bases(shape, first, shape.neurons, builder);
    }

    Random random_;
    AttributeFrames frames_;
    std::vector<Vec3> points_;
};

struct DeviceSurface {
    explicit DeviceSurface(const Surface& surface)
        : vertices(testing::upload_vertices(shared_device(), surface.vertices)),
          normals(testing::upload_vertices(shared_device(), surface.normals)) {}
    Buffer vertices, normals;
};

void expect_parity(const Shape& shape, const ReprojectionOptions& options = {}) {
    RandomModel random(shape, 7 + shape.vertices);
    CurvatureEvaluator reference(random.model);
    GpuLearnedCurvature curvature(shared_device(), random.model, options);
    Stream stream(shared_device());
    for (const bool anywhere : {false, true}) {
        const Pose pose = random.pose();
        const Surface surface = random.surface(pose, anywhere);
        const DeviceSurface on_device(surface);
        curvature.record(stream, random.rig, pose, on_device.vertices, on_device.normals);
        stream.finish();
        expect_near(testing::download_curvature(curvature),
                    reference.evaluate(random.rig, pose, surface.vertices, surface.normals),
                    anywhere ? 10 * k_tolerance : k_tolerance);
        EXPECT_EQ(curvature.farthest().control, reference.farthest().control);
        EXPECT_EQ(curvature.farthest().distance, reference.farthest().distance);
    }
}

constexpr std::array k_sets{AttributeSet::tensor, AttributeSet::principal};

TEST(LearnedCurvatureParity, OddNumbersOfVertices) {
    for (const AttributeSet set : k_sets)
        for (const std::size_t vertices : {1u, 2u, 15u, 16u, 17u, 63u, 64u, 65u, 1023u}) {
            SCOPED_TRACE(vertices);
            expect_parity({.vertices = vertices, .set = set, .segments = std::min<std::size_t>(vertices, 3)});
        }
}

TEST(LearnedCurvatureParity, WithoutComponents) {
    for (const AttributeSet set : k_sets) expect_parity({.set = set, .blocks = 0});
}

TEST(LearnedCurvatureParity, ManySegments) {
    expect_parity({.vertices = 900, .set = AttributeSet::principal, .segments = 300});
}

TEST(LearnedCurvatureParity, Neurons) {
    for (const AttributeSet set : k_sets)
        for (const std::size_t neurons : {1u, 4u, 21u}) expect_parity({.set = set, .neurons = neurons});
    expect_parity({.blocks = 0, .neurons = 7});
}

TEST(LearnedCurvatureParity, ManyComponents) {
    expect_parity({.vertices = 50, .blocks = 60, .most_components = 30});
}

TEST(LearnedCurvatureParity, BasesInManyRanges) {
    for (const AttributeSet set : k_sets) expect_parity({.vertices = 700, .set = set}, {.most_texels = 700});
}

// What suits another device than this.
TEST(LearnedCurvatureParity, AnyNumberOfVerticesPerInvocation) {
    for (const AttributeSet set : k_sets)
        for (const std::uint32_t quads : {1u, 2u, 4u})
            for (const std::size_t vertices : {16u, 65u, 700u})
                expect_parity({.vertices = vertices, .set = set}, {.quads = quads});
}

TEST(LearnedCurvatureParity, OppositeNormalsAndUprightEdgesStayFinite) {
    for (const AttributeSet set : k_sets) {
        RandomModel random({.set = set}, 4);
        const Pose pose = random.pose();
        GpuLearnedCurvature curvature(shared_device(), random.model);
        Stream stream(shared_device());
        const Surface surface = random.degenerate_surface(pose);
        const DeviceSurface on_device(surface);
        curvature.record(stream, random.rig, pose, on_device.vertices, on_device.normals);
        stream.finish();
        const VertexCurvature actual = testing::download_curvature(curvature);
        if (set == AttributeSet::tensor)
            expect_near(actual,
                        CurvatureEvaluator(random.model).evaluate(random.rig, pose, surface.vertices, surface.normals));
        for (std::size_t v = 0; v < actual.k1.size(); ++v) {
            ASSERT_TRUE(std::isfinite(actual.k1[v]) && std::isfinite(actual.k2[v])) << "vertex " << v;
            ASSERT_TRUE(actual.e1[v].allFinite() && actual.e2[v].allFinite()) << "vertex " << v;
            for (const float d : actual.derivative[v]) ASSERT_TRUE(std::isfinite(d)) << "vertex " << v;
        }
    }
}

// Each tile lies whole in one range.
TEST(TileLayout, IsCutToTheLimit) {
    RandomModel random({.vertices = 500}, 5);
    const BasisTiles& tiles = random.model.tiles;
    const std::size_t components = random.model.regression.components.size();
    for (const std::size_t most : {std::size_t{700}, std::size_t{3000}, std::size_t{1} << 20})
        for (const std::size_t alignment : {1u, 16u, 256u}) {
            const TileLayout layout = lay_out_tiles(tiles, components, 3, most, alignment);
            std::uint32_t next = 0;
            for (const TileLayout::Range& range : layout.ranges) {
                EXPECT_EQ(range.first_tile, next);
                EXPECT_EQ(range.first_texel * sizeof(shared::uvec4) % alignment, 0u);
                EXPECT_EQ(range.first_pair * sizeof(std::uint32_t) % alignment, 0u);
                EXPECT_LE(range.texels, most);
                EXPECT_EQ(layout.table[next].first_texel, range.first_texel);
                EXPECT_EQ(layout.table[next].first_pair, range.first_pair);
                next += range.tiles;
            }
            EXPECT_EQ(next, tiles.tile_count());
        }
}

TEST(TileLayout, RefusesATileOverTheLimit) {
    RandomModel random({}, 5);
    try {
        lay_out_tiles(random.model.tiles, random.model.regression.components.size(), 3, 26, 16);
        FAIL();
    } catch (const DeviceLimitError& error) {
        EXPECT_EQ(error.limit, 26u);
        EXPECT_GT(error.requested, 26u);
        EXPECT_THAT(error.what(), ::testing::HasSubstr(std::to_string(error.requested)));
    }
}

TEST(TileLayout, RefusesTilesThatReferToNothing) {
    RandomModel random({}, 5);
    const BasisTiles& good = random.model.tiles;
    const std::size_t components = random.model.regression.components.size();
    EXPECT_NO_THROW(lay_out_tiles(good, components, 3, 10000, 16));
    EXPECT_THROW(lay_out_tiles(good, components - 1, 3, 10000, 16), ModelError);
    EXPECT_NO_THROW(lay_out_tiles(good, components, 0, 10000, 16));
    const BasisTiles principal = RandomModel({.set = AttributeSet::principal}, 5).model.tiles;
    EXPECT_NO_THROW(lay_out_tiles(principal, 1000, 3, 10000, 16));
    EXPECT_THROW(lay_out_tiles(principal, 1000, 2, 10000, 16), ModelError);
    BasisTiles bad = good;
    bad.neighbor[17] = 200;
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = good;
    bad.neighbor.pop_back();
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = principal;
    bad.reference.pop_back();
    EXPECT_THROW(lay_out_tiles(bad, 1000, 3, 10000, 16), ModelError);
    bad = good;
    bad.vertex[17] = 200;
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = good;
    bad.mean.pop_back();
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
    bad = good;
    std::swap(bad.entry_begin[4], bad.entry_begin[30]);
    EXPECT_THROW(lay_out_tiles(bad, components, 3, 10000, 16), ModelError);
}

CurvatureModel trained(const Animation& animation, const CurvatureTraining& options) {
    std::vector<FrameRef> frames;
    for (std::uint32_t f = 0; f < 40; ++f) frames.push_back({0, f});
    CurvatureTrainingReport report;
    return train_curvature(animation, frames, options, report);
}

std::vector<Vec3> download_vectors(const Buffer& buffer) {
    std::vector<Vec3> vectors;
    for (const vec4& v : download(buffer)) vectors.push_back(testing::xyz(v));
    return vectors;
}

TEST(LearnedCurvatureParity, TrainedOnARig) {
    const Animation tube = shapes::bending_tube();
    const GpuSurface surface(shared_device(), tube.rest);
    GpuPoser poser(shared_device(), tube.rig, tube.rest.vertices);
    GpuNormals normals(surface);
    Stream stream(shared_device());
    for (const AttributeSet set : k_sets)
        for (const Learner learner : {Learner::additive, Learner::averaged}) {
            const CurvatureModel model = trained(tube, {.attributes = set, .learner = learner, .augmented_poses = 20});
            GpuLearnedCurvature curvature(shared_device(), model);
            CurvatureEvaluator reference(model);
            for (const Pose& pose : {tube.clips[1].poses[0], tube.clips[1].poses[7]}) {
                poser.record(stream, pose);
                normals.record(stream, poser.vertices());
                curvature.record(stream, tube.rig, pose, poser.vertices(), normals.normals());
                stream.finish();
                expect_near(testing::download_curvature(curvature),
                            reference.evaluate(tube.rig, pose, download_vectors(poser.vertices()),
                                               download_vectors(normals.normals())));
            }
        }
}

Animation waving_sheet() {
    Animation sheet;
    sheet.name = "sheet";
    sheet.kind = AnimationKind::sequence;
    sheet.rest = shapes::grid(12, 12, 2);
    Clip clip;
    clip.name = "waves";
    Random random(3);
    for (int f = 0; f < 40; ++f) {
        const float height = float(random.uniform(-0.5, 0.5)), shift = float(random.uniform(-2, 2));
        clip.frames.push_back(shapes::transformed(sheet.rest, [&](const Vec3& p) -> Vec3 {
                                  return p + Vec3(0, 0, height * std::sin(2 * p.x() + shift));
                              }).vertices);
    }
    sheet.clips = {clip};
    return sheet;
}

TEST(LearnedCurvatureParity, TrainedOnASequence) {
    const Animation sheet = waving_sheet();
    const CurvatureModel model = trained(sheet, {});
    GpuLearnedCurvature curvature(shared_device(), model);
    CurvatureEvaluator reference(model);
    Stream stream(shared_device());
    for (const std::vector<Vec3>& vertices : {sheet.clips[0].frames[3], sheet.clips[0].frames[20]}) {
        TriangleMesh frame = sheet.rest;
        frame.vertices = vertices;
        const std::vector<Vec3> normals = vertex_normals(frame);
        const DeviceSurface on_device({vertices, normals});
        curvature.record(stream, vertices, on_device.vertices, on_device.normals);
        stream.finish();
        expect_near(testing::download_curvature(curvature), reference.evaluate(vertices, normals));
    }
}

TEST(LearnedCurvatureParity, RefusesWhatIsOfAnotherModel) {
    RandomModel random({}, 5);
    GpuLearnedCurvature curvature(shared_device(), random.model);
    Stream stream(shared_device());
    const Buffer all = testing::upload_vertices(shared_device(), std::vector<Vec3>(200, Vec3::UnitZ())),
                 few = testing::upload_vertices(shared_device(), std::vector<Vec3>(199, Vec3::UnitZ()));
    const Pose pose = random.pose();
    EXPECT_THROW(curvature.record(stream, random.rig, pose, all, few), UsageError);
    EXPECT_THROW(curvature.record(stream, random.rig, pose, few, all), UsageError);
    EXPECT_THROW(curvature.record(stream, std::vector<Vec3>(200), all, all), UsageError);
    Rig shorter = random.rig;
    shorter.nodes.pop_back();
    EXPECT_THROW(curvature.record(stream, shorter, pose, all, all), UsageError);
    RandomModel segmented({.set = AttributeSet::principal}, 5);
    GpuLearnedCurvature principal(shared_device(), segmented.model);
    shorter = segmented.rig;
    shorter.bones.resize(5);
    EXPECT_THROW(principal.record(stream, shorter, segmented.pose(), all, all), UsageError);

    CurvatureModel bad = random.model;
    bad.regression.components.back().first_feature += 100;
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    bad = random.model;
    bad.state.input_count += 1;
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    bad = random.model;
    bad.range.mean.conservativeResize(2);
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    bad = random.model;
    bad.state.controls[1].input_count = 30;
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), bad), ModelError);
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), random.model, {.most_texels = 20}), DeviceLimitError);
    EXPECT_THROW(GpuLearnedCurvature(shared_device(), random.model, {.quads = 3}), UsageError);
}

// Each frame is what it would be alone, reruns are equal bit for bit, and nothing grows.
TEST(LearnedCurvatureParity, ManyFrames) {
    RandomModel random({.vertices = 300, .neurons = 5}, 9);
    GpuLearnedCurvature curvature(shared_device(), random.model);
    Stream stream(shared_device());
    struct Frame {
        Pose pose;
        DeviceSurface surface;
    };
    std::vector<Frame> frames;
    for (int i = 0; i < 10; ++i) {
        const Pose pose = random.pose();
        frames.push_back({pose, DeviceSurface(random.surface(pose, false))});
    }
    const auto run = [&](const Frame& frame) {
        curvature.record(stream, random.rig, frame.pose, frame.surface.vertices, frame.surface.normals);
        stream.finish();
        return std::array{download(curvature.first()), download(curvature.second()), download(curvature.derivative())};
    };
    std::vector<std::array<std::vector<vec4>, 3>> first;
    first.reserve(frames.size());
    for (const Frame& frame : frames) first.push_back(run(frame));
    for (int i = 0; i < 200; ++i) run(frames[0]);
    const std::size_t before = resident_bytes();
    for (std::size_t frame = 0; frame < 2000; ++frame) {
        const auto again = run(frames[frame % frames.size()]);
        for (std::size_t i = 0; i < again.size(); ++i)
            ASSERT_TRUE(same_bits(again[i], first[frame % frames.size()][i])) << "frame " << frame;
    }
    EXPECT_LE(resident_bytes(), before + 1'000'000);
}

}  // namespace
}  // namespace exemplar
