// The thesis' method for skeletons (Secs. 5.4.4, 5.4.5): every joint predicts the vertices it influences from its
// own and its parent joint's angles; the predictions are averaged.

#include <algorithm>

#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/curvature/learning/learners.h"
#include "host/learn/regression/combine.h"
#include "host/learn/regression/least_squares.h"

namespace exemplar {

namespace {

/// The prediction of one attribute by one joint.
struct JointPredictor {
    Eigen::MatrixXf basis, regression;  ///< vertices x components, components x features
    Eigen::VectorXd residual;           ///< r_j per vertex: sum of squared errors over the poses
};

/// Returns the inputs of a bone: those of its joint and of the nearest ancestor joint that is a control.
std::vector<std::uint32_t> bone_inputs(const LearningTask& task, std::size_t control) {
    const StateReader& reader = task.reader;
    std::vector<std::size_t> controls{control};
    if (const auto* joints = std::get_if<JointState>(&reader.source)) {
        const Rig& rig = task.animation.rig;
        for (std::uint32_t node = rig.nodes[joints->nodes[control]].parent; node != k_invalid_index;
             node = rig.nodes[node].parent) {
            const auto place = std::find(joints->nodes.begin(), joints->nodes.end(), node);
            if (place == joints->nodes.end()) continue;
            controls.push_back(static_cast<std::size_t>(place - joints->nodes.begin()));
            break;
        }
    }
    std::vector<std::uint32_t> inputs;
    for (const std::size_t c : controls)
        for (std::uint32_t i = 0; i < reader.controls[c].input_count; ++i)
            inputs.push_back(reader.controls[c].first_input + i);
    return inputs;
}

JointPredictor predict_from(const LearningTask& task, std::size_t attribute, const std::vector<std::uint32_t>& vertices,
                            const Eigen::MatrixXd& features) {
    const Eigen::MatrixXf values = task.centered(attribute, vertices);
    const Ica ica = task.reduce(values, attribute, vertices);
    JointPredictor predictor;
    predictor.basis = ica.mixing;
    predictor.regression = LeastSquares(features).solve(ica.sources.cast<double>()).transpose().cast<float>();
    const Eigen::MatrixXf predicted = features.cast<float>() * predictor.regression.transpose();
    predictor.residual = (values - predicted * ica.mixing.transpose()).cast<double>().colwise().squaredNorm();
    return predictor;
}

/// Multiplies the rows of the joints' bases by the weights of Eq. 5.11.
void weigh(const std::vector<std::vector<std::uint32_t>>& vertices, std::size_t vertex_count,
           std::vector<JointPredictor>& joints) {
    std::vector<std::vector<std::pair<std::size_t, Eigen::Index>>> predictors(vertex_count);
    for (std::size_t j = 0; j < joints.size(); ++j)
        for (std::size_t i = 0; i < vertices[j].size(); ++i)
            predictors[vertices[j][i]].emplace_back(j, static_cast<Eigen::Index>(i));
    for (const auto& of_vertex : predictors) {
        std::vector<double> residuals;
        residuals.reserve(of_vertex.size());
        for (const auto& [j, i] : of_vertex) residuals.push_back(joints[j].residual[i]);
        if (residuals.empty()) continue;
        const std::vector<double> weights = predictor_weights(residuals);
        for (std::size_t k = 0; k < weights.size(); ++k)
            joints[of_vertex[k].first].basis.row(of_vertex[k].second) *= static_cast<float>(weights[k]);
    }
}

}  // namespace

void learn_averaged(const LearningTask& task, PredictorBuilder& builder) {
    const std::size_t attributes = task.samples.attributes.size(), controls = task.reader.controls.size();
    const std::vector<std::vector<std::uint32_t>> vertices = vertices_of_controls(task);
    std::vector<std::vector<Monomial>> quadratic(controls), cubic(controls);
    std::vector<std::uint32_t> first(controls, 0);  // feature; the cubic features start with the quadratic ones
    for (std::size_t c = 0; c < controls; ++c) {
        if (vertices[c].empty()) continue;
        const std::vector<std::uint32_t> inputs = bone_inputs(task, c);
        quadratic[c] = polynomial_monomials(inputs, task.reader.input_count, 2);
        cubic[c] = polynomial_monomials(inputs, task.reader.input_count, 3);
        first[c] = builder.add_monomials(cubic[c]);
    }
    Progress progress("fitting", attributes);
    for (std::size_t a = 0; a < attributes; ++a) {
        const bool derivative = is_derivative(task.options.attributes, a);
        std::vector<JointPredictor> joints(controls);
        parallel_for(controls, [&](std::size_t c) {
            if (vertices[c].empty()) return;
            joints[c] = predict_from(task, a, vertices[c],
                                     monomial_values(derivative ? cubic[c] : quadratic[c], task.samples.states));
        });
        weigh(vertices, static_cast<std::size_t>(task.means.cols()), joints);
        for (std::size_t c = 0; c < controls; ++c)
            builder.add_basis(a, vertices[c], joints[c].basis, first[c], joints[c].regression);
        progress.advance();
    }
}

}  // namespace exemplar
