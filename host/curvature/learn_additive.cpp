// The sum of polynomials of the controls that matter. Joints bend a surface nearly independently, each near itself, so
// the parts of the joints add up; fitted together they share out what each explains, where an average of predictions
// that each joint makes alone (Eq. 5.10) would give every joint a part of the whole.

#include <algorithm>
#include <array>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/curvature/learners.h"
#include "host/learn/least_squares.h"

namespace exemplar {

namespace {

/// Which monomials of a control a fit uses: each family has those of the ones before, too.
enum class Family : std::size_t { linear, squares, products, cubes };
constexpr std::size_t k_families = 4;

/// Monomials of a control in the order of the families, and how many each family has. Without the constant.
struct ControlMonomials {
    std::vector<Monomial> monomials;
    std::array<std::size_t, k_families> count{};
};

ControlMonomials monomials_of(const Control& control, std::size_t input_count) {
    const auto one = static_cast<std::uint32_t>(input_count);
    const std::uint32_t first = control.first_input, end = first + control.input_count;
    ControlMonomials result;
    const auto close = [&](Family family) { result.count[static_cast<std::size_t>(family)] = result.monomials.size(); };
    for (std::uint32_t i = first; i < end; ++i) result.monomials.push_back({i, one, one});
    close(Family::linear);
    for (std::uint32_t i = first; i < end; ++i) result.monomials.push_back({i, i, one});
    close(Family::squares);
    for (std::uint32_t i = first; i < end; ++i)
        for (std::uint32_t j = i + 1; j < end; ++j) result.monomials.push_back({i, j, one});
    close(Family::products);
    for (std::uint32_t i = first; i < end; ++i) result.monomials.push_back({i, i, i});
    close(Family::cubes);
    return result;
}

/// Attributes that are fitted with the same features and ridge: those of second and those of third order.
constexpr std::size_t k_orders = 2;

/// What was chosen for a group and order.
struct Choice {
    std::size_t family = 0;
    double ridge = 0;
};

class AdditiveLearner {
  public:
    explicit AdditiveLearner(const LearningTask& task)
        : task_(task), vertices_(vertices_of_controls(task)), attributes_(task.samples.attributes.size()) {
        for (const Control& control : task.reader.controls) {
            monomials_.push_back(monomials_of(control, task.reader.input_count));
            values_.push_back(monomial_values(monomials_.back().monomials, task.samples.states));
        }
        for (std::size_t c = 0; c < monomials_.size(); ++c) {
            const auto features = static_cast<Eigen::Index>(monomials_[c].monomials.size());
            coefficients_.emplace_back(attributes_, Eigen::MatrixXf::Zero(features, Eigen::Index(vertices_[c].size())));
        }
    }

    void learn(PredictorBuilder& builder) {
        Progress fitting("fitting", task_.groups.size());
        parallel_for(task_.groups.size(), [&](std::size_t g) {
            if (!task_.groups[g].controls.empty()) fit_group(task_.groups[g]);
            fitting.advance();
        });
        fitting.finish();
        std::vector<std::vector<Reduced>> reduced(monomials_.size(), std::vector<Reduced>(attributes_));
        Progress reducing("reducing", monomials_.size() * attributes_);
        parallel_for(monomials_.size() * attributes_, [&](std::size_t i) {
            reduced[i / attributes_][i % attributes_] = reduce(i / attributes_, i % attributes_);
            reducing.advance();
        });
        for (std::size_t c = 0; c < monomials_.size(); ++c) add_blocks(c, reduced[c], builder);
    }

  private:
    struct Reduced {
        Eigen::MatrixXf basis, regression;
    };

    /// Features of a family of some controls, the constant first.
    Eigen::MatrixXd features(const std::vector<std::uint32_t>& controls, std::size_t family) const {
        Eigen::Index count = 1;
        for (const std::uint32_t c : controls) count += Eigen::Index(monomials_[c].count[family]);
        Eigen::MatrixXd result(task_.poses(), count);
        result.col(0).setOnes();
        Eigen::Index at = 1;
        for (const std::uint32_t c : controls) {
            const auto width = Eigen::Index(monomials_[c].count[family]);
            result.middleCols(at, width) = values_[c].leftCols(width);
            at += width;
        }
        return result;
    }

    bool is_of_order(std::size_t attribute, std::size_t order) const {
        return is_derivative(task_.options.attributes, attribute) == (order == 1);
    }

    /// Some of a group's values of one order, each attribute scaled to unit variance: what the choice is made on.
    Eigen::MatrixXd choice_targets(const InfluenceGroup& group, std::size_t order) const {
        constexpr std::size_t k_vertices = 48;
        std::vector<std::uint32_t> vertices;
        const std::size_t count = std::min(group.vertices.size(), k_vertices);
        for (std::size_t i = 0; i < count; ++i) vertices.push_back(group.vertices[i * group.vertices.size() / count]);
        Eigen::MatrixXd targets(task_.poses(), 0);
        for (std::size_t a = 0; a < attributes_; ++a) {
            if (!is_of_order(a, order)) continue;
            const Eigen::MatrixXd values = task_.centered(a, vertices).cast<double>();
            targets.conservativeResize(Eigen::NoChange, targets.cols() + values.cols());
            targets.rightCols(values.cols()) = values / std::max(values.norm(), 1e-20);
        }
        return targets;
    }

    Choice choose(const InfluenceGroup& group, std::size_t order) const {
        const Eigen::MatrixXd targets = choice_targets(group, order);
        Choice best;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t family = 0; family < k_families; ++family) {
            const RidgeChoice ridge = leave_blocks_out(features(group.controls, family), targets, ridge_candidates(),
                                                       validation_blocks(task_.poses()));
            if (ridge.error < least) {
                least = ridge.error;
                best = {family, ridge.ridge};
            }
        }
        return best;
    }

    void fit_group(const InfluenceGroup& group) {
        check_interrupt();
        for (std::size_t order = 0; order < k_orders; ++order) {
            const Choice choice = choose(group, order);
            const LeastSquares fit(features(group.controls, choice.family), choice.ridge);
            for (std::size_t a = 0; a < attributes_; ++a)
                if (is_of_order(a, order))
                    keep(group, choice.family, a, fit.solve(task_.centered(a, group.vertices).cast<double>()));
        }
    }

    /// Sorts a group's coefficients (features x vertices) to their controls. Groups share no vertices, so no two write
    /// to the same place.
    void keep(const InfluenceGroup& group, std::size_t family, std::size_t attribute, const Eigen::MatrixXd& solution) {
        Eigen::Index at = 1;
        for (const std::uint32_t c : group.controls) {
            const auto width = Eigen::Index(monomials_[c].count[family]);
            for (std::size_t i = 0; i < group.vertices.size(); ++i) {
                const auto place = std::lower_bound(vertices_[c].begin(), vertices_[c].end(), group.vertices[i]);
                coefficients_[c][attribute].col(place - vertices_[c].begin()).head(width) =
                    solution.col(Eigen::Index(i)).segment(at, width).cast<float>();
            }
            at += width;
        }
    }

    /// The part of a control in training, poses x vertices, reduced to components that follow from its features.
    Reduced reduce(std::size_t control, std::size_t attribute) const {
        const Eigen::MatrixXf& coefficients = coefficients_[control][attribute];
        if (coefficients.cols() == 0) return {};
        const Eigen::RowVectorXf mean = values_[control].colwise().mean().cast<float>();
        const Eigen::MatrixXf centered = values_[control].cast<float>().rowwise() - mean;
        const Ica ica = task_.reduce(centered * coefficients);
        Reduced result;
        result.basis = ica.mixing;
        result.regression.resize(ica.unmixing.rows(), coefficients.rows() + 1);
        result.regression.rightCols(coefficients.rows()) = ica.unmixing * coefficients.transpose();
        result.regression.col(0) = -result.regression.rightCols(coefficients.rows()) * mean.transpose();
        return result;
    }

    void add_blocks(std::size_t control, const std::vector<Reduced>& reduced, PredictorBuilder& builder) const {
        const bool is_used =
            std::any_of(reduced.begin(), reduced.end(), [](const Reduced& r) { return r.basis.cols() > 0; });
        if (!is_used) return;
        const auto one = static_cast<std::uint32_t>(task_.reader.input_count);
        std::vector<Monomial> all{{one, one, one}};
        all.insert(all.end(), monomials_[control].monomials.begin(), monomials_[control].monomials.end());
        const std::uint32_t first = builder.add_monomials(all);
        for (std::size_t a = 0; a < attributes_; ++a)
            builder.add_basis(a, vertices_[control], reduced[a].basis, first, reduced[a].regression);
    }

    const LearningTask& task_;
    std::vector<std::vector<std::uint32_t>> vertices_;  // of each control
    std::size_t attributes_;
    std::vector<ControlMonomials> monomials_;                 // of each control
    std::vector<Eigen::MatrixXd> values_;                     // of each control: poses x monomials
    std::vector<std::vector<Eigen::MatrixXf>> coefficients_;  // of each control and attribute: monomials x vertices
};

}  // namespace

void learn_additive(const LearningTask& task, PredictorBuilder& builder) {
    AdditiveLearner(task).learn(builder);
}

}  // namespace exemplar
