#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "host/core/random.h"
#include "host/curvature/learning/model_builder.h"
#include "host/curvature/model/model.h"
#include "host/curvature/model/tiling.h"
#include "tests/parity/surfaces.h"

namespace exemplar::test_support {

struct Shape {
    std::size_t vertices = 200;
    AttributeSet set = AttributeSet::tensor;
    std::size_t segments = 3;  // of principal attributes
    std::size_t blocks = 10;   // of components that share their features
    std::size_t neurons = 0;
    std::size_t max_components = 5;  // of a block and attribute
};

struct Surface {
    std::vector<Vec3> vertices, normals;
};

// A model without sense, of a rig of ten bones.
class RandomModel {
  public:
    RandomModel(const Shape& shape, std::uint64_t seed) : random_(seed) {
        rig = random_rig(shape.vertices, 10, 2, random_);
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
                normals.push_back(frame_of_normal(edge.normalized()).tangent);
            else
                normals.push_back(Vec3::UnitY());
        return normals;
    }

    void add_state() {
        auto& joints = model.state.source.emplace<JointState>();
        for (std::uint32_t n = 0; n < rig.nodes.size(); n += 2) {
            joints.nodes.push_back(n);
            joints.reference.push_back(random_transform(random_).rotation);
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
            const std::size_t components = 1 + random_.index(shape.max_components);
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

}  // namespace exemplar::test_support
