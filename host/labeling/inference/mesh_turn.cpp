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
constexpr double k_min_agreement = 1e-4;                    // no single face decides
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

/// The probabilities of a stage, rows x classes.
std::vector<float> probabilities_of(const LabelingModel& model, const CalibratedStumps& stage,
                                    const LinearExpert* linear, const FeatureMatrix& rows) {
    std::vector<float> probabilities(rows.rows * model.class_count());
    CpuStumpScorer scorer;  // few rows many times: a device would mostly wait
    scorer.probabilities(stage.stumps, rows, stage.link, stage.scale, probabilities);
    if (linear) pool(*linear, rows, model.averaged_labels, probabilities);
    return probabilities;
}

/// Says how well the first stage of a model fits a mesh that is turned in various ways.
class TurnJudge {
  public:
    TurnJudge(const LabelingModel& model, const MeshFeatures& features)
        : model_(model), base_(model.unary_names.size() - 3), faces_(features.unary.rows) {
        const auto& samples = features.context.sample_face;
        face_.assign(samples.begin(), samples.begin() + std::min(samples.size(), k_judged_faces));
        for (const std::uint32_t face : face_)
            position_.push_back(
                {features.position[face], features.position[faces_ + face], features.position[2 * faces_ + face]});
        base_values_.rows = face_.size();
        for (std::size_t f = 0; f < base_; ++f) {
            const std::span<float> column = base_values_.add(features.unary.names[f]);
            for (std::size_t i = 0; i < face_.size(); ++i) column[i] = features.unary.column(f)[face_[i]];
        }
        as_shaped_ = probabilities_of(model, model.unoriented, &model.unoriented_linear, base_values_);
    }

    /// Per turn, the mean over the judged faces of sum_c P_c log P_c + log sum_c P_c Q_c: at most 0, which it is where
    /// the stage (P) is sure and the stage without coordinates (Q) is sure of the same.
    std::vector<double> fitness(std::span<const Eigen::Matrix3f> turns) {
        std::vector<double> result;
        for (; !turns.empty(); turns = turns.subspan(std::min(turns.size(), k_turns_at_once)))
            for (const double value : fitness_of_some(turns.first(std::min(turns.size(), k_turns_at_once))))
                result.push_back(value);
        return result;
    }

  private:
    std::vector<double> fitness_of_some(std::span<const Eigen::Matrix3f> turns) {
        check_interrupt();
        const std::size_t count = face_.size(), classes = model_.class_count();
        FeatureMatrix rows;
        rows.rows = turns.size() * count;
        rows.names = model_.unary_names;
        rows.values.resize(rows.cols() * rows.rows);
        for (std::size_t f = 0; f < base_; ++f)
            for (std::size_t t = 0; t < turns.size(); ++t)
                std::ranges::copy(base_values_.column(f),
                                  rows.column(f).begin() + static_cast<std::ptrdiff_t>(t * count));
        for (std::size_t t = 0; t < turns.size(); ++t)
            for (std::size_t i = 0; i < count; ++i) {
                const Eigen::Vector3f at = turns[t] * position_[i];
                for (std::size_t axis = 0; axis < 3; ++axis) rows.column(base_ + axis)[t * count + i] = at[axis];
            }
        const std::vector<float> lying = probabilities_of(
            model_, model_.unary.front(), model_.linear.empty() ? nullptr : &model_.linear.front(), rows);
        std::vector<double> result(turns.size(), 0);
        for (std::size_t row = 0; row < rows.rows; ++row) {
            const std::span p = std::span(lying).subspan(row * classes, classes);
            const std::span q = std::span(as_shaped_).subspan(row % count * classes, classes);
            double certainty = 0, agreement = 0;
            for (std::size_t c = 0; c < classes; ++c) {
                certainty += p[c] > 0 ? double{p[c]} * std::log(double{p[c]}) : 0;
                agreement += double{p[c]} * double{q[c]};
            }
            result[row / count] +=
                (certainty + std::log(std::max(agreement, k_min_agreement))) / static_cast<double>(count);
        }
        return result;
    }

    const LabelingModel& model_;
    std::size_t base_, faces_;
    std::vector<std::uint32_t> face_;
    std::vector<Eigen::Vector3f> position_;
    FeatureMatrix base_values_;     ///< of the judged faces, without coordinates
    std::vector<float> as_shaped_;  ///< probabilities without coordinates
};

/// Turns a little further about one axis, by at most one step of each size, where that is better.
Eigen::Matrix3f refine(TurnJudge& judge, Eigen::Matrix3f best, double fitness) {
    for (const float degrees : k_refinements) {
        Turns near;
        for (int axis = 0; axis < 3; ++axis)
            for (const float sign : {-1.0F, 1.0F})
                near.emplace_back(about(Eigen::Vector3f::Unit(axis), sign * degrees) * best);
        const std::vector<double> values = judge.fitness(near);
        const auto found = std::ranges::max_element(values);
        if (*found > fitness) fitness = *found, best = near[static_cast<std::size_t>(found - values.begin())];
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
    const std::vector<double> fitness = judge.fitness(turns);
    const auto best = static_cast<std::size_t>(std::ranges::max_element(fitness) - fitness.begin());
    if (fitness[best] < fitness.front() + k_min_gain) return Eigen::Matrix3f::Identity();
    return refine(judge, turns[best], fitness[best]);
}

}  // namespace exemplar
