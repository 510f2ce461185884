#include "host/labeling/inference/mesh_turn.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/labeling/inference/linear_expert.h"

namespace exemplar {
namespace {

constexpr std::size_t k_judged_faces = 200;  // the first samples, which lie as far apart as so many can
constexpr std::size_t k_turns_at_once = 24;
constexpr double k_min_gain = 0.05;                         // nats a face; below, the mesh stays as it lies
constexpr std::array<float, 2> k_refinements{20.0F, 8.0F};  // degrees about each axis

using Turns = std::vector<Eigen::Matrix3f>;

Eigen::Matrix3f about(const Eigen::Vector3f& axis, float degrees) {
    return Eigen::AngleAxisf(degrees * std::numbers::pi_v<float> / 180, axis.normalized()).toRotationMatrix();
}

/// The rotations that turn axes to axes.
Turns axis_turns() {
    Turns turns;
    std::array<int, 3> order{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Eigen::Matrix3f turn = Eigen::Matrix3f::Zero();
            for (int row = 0; row < 3; ++row) turn(row, order[row]) = (signs >> row & 1) ? -1.0F : 1.0F;
            if (turn.determinant() > 0) turns.push_back(turn);
        }
    } while (std::ranges::next_permutation(order).found);
    return turns;
}

/// Says how sure the first stage of a model is of a mesh that is turned in various ways.
class TurnJudge {
  public:
    TurnJudge(const LabelingModel& model, const MeshFeatures& features)
        : model_(model), base_(model.unary_names.size() - 3), faces_(features.unary.rows) {
        const auto& samples = features.context.sample_face;
        face_.assign(samples.begin(), samples.begin() + std::min(samples.size(), k_judged_faces));
        for (const std::uint32_t face : face_)
            position_.push_back(
                {features.position[face], features.position[faces_ + face], features.position[2 * faces_ + face]});
        for (std::size_t f = 0; f < base_; ++f)
            for (const std::uint32_t face : face_) base_values_.push_back(features.unary.column(f)[face]);
    }

    /// The mean of sum_c P_c log P_c over the judged faces, per turn: 0 where the stage is sure, else less.
    std::vector<double> certainty(std::span<const Eigen::Matrix3f> turns) {
        std::vector<double> result;
        for (; !turns.empty(); turns = turns.subspan(std::min(turns.size(), k_turns_at_once)))
            for (const double value : certainty_of_some(turns.first(std::min(turns.size(), k_turns_at_once))))
                result.push_back(value);
        return result;
    }

  private:
    std::vector<double> certainty_of_some(std::span<const Eigen::Matrix3f> turns) {
        check_interrupt();
        const std::size_t count = face_.size(), classes = model_.class_count();
        FeatureMatrix rows;
        rows.rows = turns.size() * count;
        rows.names = model_.unary_names;
        rows.values.resize(rows.cols() * rows.rows);
        for (std::size_t f = 0; f < base_; ++f)
            for (std::size_t t = 0; t < turns.size(); ++t)
                std::copy_n(base_values_.begin() + f * count, count, rows.column(f).begin() + t * count);
        for (std::size_t t = 0; t < turns.size(); ++t)
            for (std::size_t i = 0; i < count; ++i) {
                const Eigen::Vector3f at = turns[t] * position_[i];
                for (std::size_t axis = 0; axis < 3; ++axis) rows.column(base_ + axis)[t * count + i] = at[axis];
            }
        std::vector<float> probabilities(rows.rows * classes);
        const CalibratedStumps& stage = model_.unary.front();
        scorer_.probabilities(stage.stumps, rows, stage.link, stage.scale, probabilities);
        if (!model_.linear.empty()) pool(model_.linear.front(), rows, model_.averaged_labels, probabilities);
        std::vector<double> result(turns.size(), 0);
        for (std::size_t i = 0; i < probabilities.size(); ++i)
            if (const double p = probabilities[i]; p > 0)
                result[i / (count * classes)] += p * std::log(p) / static_cast<double>(count);
        return result;
    }

    const LabelingModel& model_;
    CpuStumpScorer scorer_;  // few rows many times: a device would mostly wait
    std::size_t base_, faces_;
    std::vector<std::uint32_t> face_;
    std::vector<Eigen::Vector3f> position_;
    std::vector<float> base_values_;  ///< base features without coordinates, feature-major
};

/// Turns a little further about one axis, by at most one step of each size, where that is better.
Eigen::Matrix3f refine(TurnJudge& judge, Eigen::Matrix3f best, double certainty) {
    for (const float degrees : k_refinements) {
        Turns near;
        for (int axis = 0; axis < 3; ++axis)
            for (const float sign : {-1.0F, 1.0F})
                near.emplace_back(about(Eigen::Vector3f::Unit(axis), sign * degrees) * best);
        const std::vector<double> values = judge.certainty(near);
        const auto found = std::ranges::max_element(values);
        if (*found > certainty) certainty = *found, best = near[static_cast<std::size_t>(found - values.begin())];
    }
    return best;
}

}  // namespace

std::vector<std::string> orientation_names() {
    return {"orientation.x", "orientation.y", "orientation.z"};
}

bool uses_orientation(const LabelingModel& model) {
    return model.unary_names.size() > 3 && model.unary_names.back() == orientation_names().back();
}

void set_orientation(MeshFeatures& features, std::size_t base, const Eigen::Matrix3f& turn) {
    FeatureMatrix& unary = features.unary;
    const std::size_t faces = unary.rows;
    if (features.position.size() != 3 * faces)
        throw ModelError("the model knows faces by where they are, but the features of this mesh have no positions");
    if (unary.cols() < base) throw ModelError("the features of this mesh are fewer than those of the model");
    unary.names.resize(base);
    unary.values.resize(base * faces);
    for (const std::string& name : orientation_names()) unary.add(name);
    const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3>> from(features.position.data(),
                                                                         static_cast<Eigen::Index>(faces), 3);
    Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, 3>>(unary.column(base).data(), static_cast<Eigen::Index>(faces), 3)
        .noalias() = from * turn.transpose();
}

std::vector<Eigen::Matrix3f> coarse_turns() {
    const Turns axes = axis_turns();
    Turns turns = axes;
    for (int axis = 0; axis < 3; ++axis)
        for (const Eigen::Matrix3f& turn : axes) turns.emplace_back(about(Eigen::Vector3f::Unit(axis), 45) * turn);
    for (int signs = 0; signs < 4; ++signs) {
        const Eigen::Vector3f diagonal((signs & 1) ? -1.0F : 1.0F, (signs & 2) ? -1.0F : 1.0F, 1);
        for (const Eigen::Matrix3f& turn : axes) turns.emplace_back(about(diagonal, 60) * turn);
    }
    return turns;
}

Eigen::Matrix3f likeliest_turn(const LabelingModel& model, const MeshFeatures& features) {
    TurnJudge judge(model, features);
    const Turns turns = coarse_turns();
    const std::vector<double> certainty = judge.certainty(turns);
    const auto best = static_cast<std::size_t>(std::ranges::max_element(certainty) - certainty.begin());
    if (certainty[best] < certainty.front() + k_min_gain) return Eigen::Matrix3f::Identity();
    return refine(judge, turns[best], certainty[best]);
}

}  // namespace exemplar
