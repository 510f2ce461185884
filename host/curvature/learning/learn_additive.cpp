// A sum of polynomials of the controls that influence a vertex, and of pairs of them. Joints bend a surface nearly
// independently, each near itself, so their contributions add up. Fitting all of them at once attributes to
// each joint what it explains; averaging predictions of single joints (Eq. 5.10) would give each a share of the
// whole.

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/curvature/learning/learners.h"
#include "host/learn/regression/least_squares.h"

namespace exemplar {

namespace {

/// Family of features that a fit uses. Each family contains the previous ones; pairs are products of inputs of two
/// controls.
enum class Family : std::size_t { linear, squares, products, cubes, pairs };
constexpr std::size_t k_families = 5;

/// Controls: one, or two whose inputs are multiplied.
using Controls = std::vector<std::uint32_t>;

/// A term of the sum: features of one control or of a pair, with coefficients for the vertices they influence.
struct Term {
    std::vector<Monomial> monomials;              ///< without the constant, ordered by family
    std::array<std::size_t, k_families> count{};  ///< number of them in each family
    Eigen::MatrixXd values;                       ///< poses x monomials
    std::vector<std::uint32_t> vertices;          ///< ascending
    std::vector<Eigen::MatrixXf> coefficients{};  ///< per attribute: monomials x vertices
};

void close(Term& term, Family family) {
    for (auto f = static_cast<std::size_t>(family); f < k_families; ++f) term.count[f] = term.monomials.size();
}

Term term_of_control(const Control& control, std::uint32_t one) {
    const std::uint32_t first = control.first_input, end = first + control.input_count;
    Term term;
    for (std::uint32_t i = first; i < end; ++i) term.monomials.push_back({i, one, one});
    close(term, Family::linear);
    for (std::uint32_t i = first; i < end; ++i) term.monomials.push_back({i, i, one});
    close(term, Family::squares);
    for (std::uint32_t i = first; i < end; ++i)
        for (std::uint32_t j = i + 1; j < end; ++j) term.monomials.push_back({i, j, one});
    close(term, Family::products);
    for (std::uint32_t i = first; i < end; ++i) term.monomials.push_back({i, i, i});
    close(term, Family::cubes);
    return term;
}

Term term_of_pair(const Control& a, const Control& b, std::uint32_t one) {
    Term term;
    for (std::uint32_t i = 0; i < a.input_count; ++i)
        for (std::uint32_t j = 0; j < b.input_count; ++j)
            term.monomials.push_back({a.first_input + i, b.first_input + j, one});
    term.count[static_cast<std::size_t>(Family::pairs)] = term.monomials.size();
    return term;
}

/// The controls of a group and their pairs.
std::vector<Controls> terms_of_group(const InfluenceGroup& group) {
    std::vector<Controls> terms;
    for (const std::uint32_t c : group.controls) terms.push_back({c});
    for (std::size_t i = 0; i < group.controls.size(); ++i)
        for (std::size_t j = i + 1; j < group.controls.size(); ++j)
            terms.push_back({group.controls[i], group.controls[j]});
    return terms;
}

/// Attributes of the same order, second or third, are fitted with the same features and ridge.
constexpr std::size_t k_orders = 2;

/// A family and a ridge for each order.
struct Choice {
    std::size_t family = 0;
    double ridge = 0;
};
using Choices = std::array<Choice, k_orders>;

class AdditiveLearner {
  public:
    explicit AdditiveLearner(const LearningTask& task) : task_(task), attributes_(task.samples.attributes.size()) {
        const auto one = static_cast<std::uint32_t>(task.reader.input_count);
        const auto& controls = task.reader.controls;
        for (const InfluenceGroup& group : task.groups)
            for (const Controls& key : terms_of_group(group)) {
                const auto [place, is_new] = terms_.try_emplace(key);
                Term& term = place->second;
                if (is_new)
                    term = key.size() == 1 ? term_of_control(controls[key[0]], one)
                                           : term_of_pair(controls[key[0]], controls[key[1]], one);
                term.vertices.insert(term.vertices.end(), group.vertices.begin(), group.vertices.end());
            }
        for (auto& [key, term] : terms_) {
            std::sort(term.vertices.begin(), term.vertices.end());
            term.values = monomial_values(term.monomials, task.samples.states);
        }
    }

    void learn(PredictorBuilder& builder) {
        make_choices();
        for (auto& [key, term] : terms_)
            if (key.size() == 1 || uses_pairs_)
                term.coefficients.assign(attributes_, Eigen::MatrixXf::Zero(Eigen::Index(term.monomials.size()),
                                                                            Eigen::Index(term.vertices.size())));
        Progress fitting("fitting", task_.groups.size());
        parallel_for(task_.groups.size(), [&](std::size_t g) {
            if (!task_.groups[g].controls.empty()) fit_group(task_.groups[g]);
            fitting.advance();
        });
        fitting.finish();
        reduce_all(builder);
    }

  private:
    /// Returns the features of a group's terms in a family, the constant first.
    Eigen::MatrixXd features(const InfluenceGroup& group, std::size_t family) const {
        const std::vector<Controls> keys = terms_of_group(group);
        Eigen::Index count = 1;
        for (const Controls& key : keys) count += Eigen::Index(terms_.at(key).count[family]);
        Eigen::MatrixXd result(task_.poses(), count);
        result.col(0).setOnes();
        Eigen::Index at = 1;
        for (const Controls& key : keys) {
            const Term& term = terms_.at(key);
            const auto width = Eigen::Index(term.count[family]);
            result.middleCols(at, width) = term.values.leftCols(width);
            at += width;
        }
        return result;
    }

    bool is_of_order(std::size_t attribute, std::size_t order) const {
        return is_derivative(task_.options.attributes, attribute) == (order == 1);
    }

    /// Returns a sample of a group's values of one order, each attribute scaled to unit norm, to choose a model on.
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

    /// Returns the family and ridge of each order with the smallest error of cross-validation over blocks of poses.
    Choices choose(const InfluenceGroup& group) const {
        check_interrupt();
        Choices choices;
        for (std::size_t order = 0; order < k_orders; ++order) {
            const Eigen::MatrixXd targets = choice_targets(group, order);
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t family = 0; family < k_families; ++family) {
                const Eigen::MatrixXd candidate = features(group, family);
                if (2 * candidate.cols() > candidate.rows()) break;
                const RidgeChoice ridge =
                    leave_blocks_out(candidate, targets, ridge_candidates(), validation_blocks(task_.poses()));
                if (!(ridge.error < least)) continue;
                least = ridge.error;
                choices[order] = {family, ridge.ridge};
            }
            if (least == std::numeric_limits<double>::infinity())
                choices[order] = {0, ridge_candidates().back() * static_cast<double>(task_.poses())};
        }
        return choices;
    }

    /// Makes choices for the largest groups. The others use that of the largest group with as many controls, or else
    /// with the next larger number of controls.
    void make_choices() {
        constexpr std::size_t k_chosen = 64;
        std::vector<std::size_t> largest;
        for (std::size_t g = 0; g < task_.groups.size(); ++g)
            if (!task_.groups[g].controls.empty()) largest.push_back(g);
        std::stable_sort(largest.begin(), largest.end(), [&](std::size_t a, std::size_t b) {
            return task_.groups[a].vertices.size() > task_.groups[b].vertices.size();
        });
        largest.resize(std::min(largest.size(), k_chosen));
        std::vector<Choices> made(largest.size());
        Progress progress("choosing", largest.size());
        parallel_for(largest.size(), [&](std::size_t i) {
            made[i] = choose(task_.groups[largest[i]]);
            progress.advance();
        });
        for (std::size_t i = 0; i < largest.size(); ++i) {
            chosen_[largest[i]] = made[i];
            by_count_.try_emplace(task_.groups[largest[i]].controls.size(), made[i]);
            for (const Choice& choice : made[i])
                uses_pairs_ |= choice.family == static_cast<std::size_t>(Family::pairs);
        }
    }

    const Choices& choices_of(const InfluenceGroup& group) const {
        const auto own = chosen_.find(static_cast<std::size_t>(&group - task_.groups.data()));
        if (own != chosen_.end()) return own->second;
        const auto above = by_count_.lower_bound(group.controls.size());
        return above == by_count_.end() ? by_count_.rbegin()->second : above->second;
    }

    void fit_group(const InfluenceGroup& group) {
        check_interrupt();
        const Choices& choices = choices_of(group);
        for (std::size_t order = 0; order < k_orders; ++order) {
            const LeastSquares fit(features(group, choices[order].family), choices[order].ridge);
            for (std::size_t a = 0; a < attributes_; ++a)
                if (is_of_order(a, order))
                    keep(group, choices[order].family, a, fit.solve(task_.centered(a, group.vertices).cast<double>()));
        }
    }

    /// Stores a group's coefficients (features x vertices) in their terms. Groups share no vertices, so parallel
    /// writes never overlap.
    void keep(const InfluenceGroup& group, std::size_t family, std::size_t attribute, const Eigen::MatrixXd& solution) {
        Eigen::Index at = 1;
        for (const Controls& key : terms_of_group(group)) {
            Term& term = terms_.at(key);
            const auto width = Eigen::Index(term.count[family]);
            if (width == 0) continue;
            for (std::size_t i = 0; i < group.vertices.size(); ++i) {
                const auto place = std::lower_bound(term.vertices.begin(), term.vertices.end(), group.vertices[i]);
                term.coefficients[attribute].col(place - term.vertices.begin()).head(width) =
                    solution.col(Eigen::Index(i)).segment(at, width).cast<float>();
            }
            at += width;
        }
    }

    struct Reduced {
        Eigen::MatrixXf basis, regression;
    };

    /// Reduces a term's contribution in training, poses x vertices, to components that are linear in its features.
    Reduced reduce(const Term& term, std::size_t attribute) const {
        const Eigen::MatrixXf& coefficients = term.coefficients[attribute];
        const Eigen::RowVectorXf mean = term.values.colwise().mean().cast<float>();
        const Eigen::MatrixXf centered = term.values.cast<float>().rowwise() - mean;
        const Ica ica = task_.reduce(centered * coefficients, attribute, term.vertices);
        Reduced result;
        result.basis = ica.mixing;
        result.regression.resize(ica.unmixing.rows(), coefficients.rows() + 1);
        result.regression.rightCols(coefficients.rows()) = ica.unmixing * coefficients.transpose();
        result.regression.col(0) = -result.regression.rightCols(coefficients.rows()) * mean.transpose();
        return result;
    }

    void reduce_all(PredictorBuilder& builder) const {
        std::vector<const Term*> used;
        for (const auto& [key, term] : terms_)
            if (!term.coefficients.empty() && !term.vertices.empty()) used.push_back(&term);
        std::vector<std::vector<Reduced>> reduced(used.size(), std::vector<Reduced>(attributes_));
        Progress reducing("reducing", used.size() * attributes_);
        parallel_for(used.size() * attributes_, [&](std::size_t i) {
            reduced[i / attributes_][i % attributes_] = reduce(*used[i / attributes_], i % attributes_);
            reducing.advance();
        });
        for (std::size_t t = 0; t < used.size(); ++t) add_blocks(*used[t], reduced[t], builder);
    }

    void add_blocks(const Term& term, const std::vector<Reduced>& reduced, PredictorBuilder& builder) const {
        const bool is_used =
            std::any_of(reduced.begin(), reduced.end(), [](const Reduced& r) { return r.basis.cols() > 0; });
        if (!is_used) return;
        const auto one = static_cast<std::uint32_t>(task_.reader.input_count);
        std::vector<Monomial> all{{one, one, one}};
        all.insert(all.end(), term.monomials.begin(), term.monomials.end());
        const std::uint32_t first = builder.add_monomials(all);
        for (std::size_t a = 0; a < attributes_; ++a)
            builder.add_basis(a, term.vertices, reduced[a].basis, first, reduced[a].regression);
    }

    const LearningTask& task_;
    std::size_t attributes_;
    std::map<Controls, Term> terms_;
    std::map<std::size_t, Choices> chosen_;    // of the largest groups
    std::map<std::size_t, Choices> by_count_;  // per number of controls: of the largest group
    bool uses_pairs_ = false;
};

}  // namespace

void learn_additive(const LearningTask& task, PredictorBuilder& builder) {
    AdditiveLearner(task).learn(builder);
}

}  // namespace exemplar
