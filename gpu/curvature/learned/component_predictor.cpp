#include "gpu/curvature/learned/component_predictor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "embedded/curvature_components_comp.h"
#include "embedded/curvature_features_comp.h"
#include "gpu/curvature/learned/row_threads.h"
#include "gpu/curvature/surface/texels.h"
#include "host/core/errors.h"
#include "shaders/shared/curvature.h"

namespace exemplar {
namespace {

using shared::ComponentParameters;
using shared::CurvatureComponent;
using shared::CurvatureFeature;
using shared::FeatureParameters;
using shared::uvec4;
using shared::vec4;

// The kernels fetch each as one four-component vector.
static_assert(sizeof(CurvatureFeature) == 16 && sizeof(CurvatureComponent) == 16);

// Features in runs, one per range of features that components use, in their order. Runs begin at whole texels.
struct FeatureRuns {
    std::vector<CurvatureFeature> features;
    std::vector<CurvatureComponent> components;
    std::vector<float> coefficients;
};

CurvatureFeature feature_at(const ComponentRegression& regression, std::size_t index) {
    if (index >= regression.monomials.size())
        return {0, 0, 0, static_cast<std::uint32_t>(index - regression.monomials.size() + 1)};
    const auto one = static_cast<std::uint32_t>(regression.input_count);
    const auto& [a, b, c] = regression.monomials[index];
    return {std::min(a, one), std::min(b, one), std::min(c, one), 0};
}

void append_run(const ComponentRegression& regression, const ComponentRegression::Component& part, FeatureRuns& runs) {
    const auto one = static_cast<std::uint32_t>(regression.input_count);
    for (std::size_t i = 0; i < part.feature_count; ++i)
        runs.features.push_back(feature_at(regression, part.first_feature + i));
    while (runs.features.size() % 4 != 0) runs.features.push_back({one, one, one, 0});
}

FeatureRuns gather_runs(const ComponentRegression& regression) {
    FeatureRuns runs;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_texel;
    for (const ComponentRegression::Component& part : regression.components) {
        if (std::size_t{part.first_feature} + part.feature_count > regression.feature_count() ||
            std::size_t{part.first_coefficient} + part.feature_count > regression.coefficients.size())
            throw ModelError(
                fmt::format("a curvature model is damaged: component {} has features or coefficients that "
                            "do not exist; train it again",
                            runs.components.size()));
        const auto [run, is_new] = first_texel.try_emplace({part.first_feature, part.feature_count},
                                                           static_cast<std::uint32_t>(runs.features.size() / 4));
        if (is_new) append_run(regression, part, runs);
        runs.components.push_back({.first_feature = run->second,
                                   .feature_texels = (part.feature_count + 3) / 4,
                                   .first_coefficient = static_cast<std::uint32_t>(runs.coefficients.size() / 4),
                                   .unused = 0});
        const auto from = regression.coefficients.begin() + part.first_coefficient;
        runs.coefficients.insert(runs.coefficients.end(), from, from + part.feature_count);
        while (runs.coefficients.size() % 4 != 0) runs.coefficients.push_back(0);
    }
    return runs;
}

// Rows of `columns` floats: the weights of the inputs, then the bias.
std::vector<float> padded_weights(const ComponentRegression& regression, std::size_t columns) {
    const auto neurons = static_cast<std::size_t>(regression.neurons.rows());
    if (neurons != 0 && (regression.neurons.cols() != static_cast<Eigen::Index>(regression.input_count) ||
                         regression.neuron_bias.size() != regression.neurons.rows()))
        throw ModelError("a curvature model is damaged: its neurons are not of its inputs; train it again");
    std::vector<float> weights(neurons * columns, 0.0f);
    for (std::size_t n = 0; n < neurons; ++n) {
        const auto row = static_cast<Eigen::Index>(n);
        float* const out = weights.data() + n * columns;
        std::copy_n(regression.neurons.data() + n * regression.input_count, regression.input_count, out);
        out[regression.input_count] = regression.neuron_bias[row];
    }
    return weights;
}

}  // namespace

GpuComponentPredictor::GpuComponentPredictor(Device& device, const ComponentRegression& regression)
    : input_texels_(regression.input_count / 4 + 1),
      component_count_(regression.components.size()),
      component_threads_(row_threads(device, component_count_)),
      feature_kernel_(device, shaders::curvature_features_comp,
                      {.push_constants = layout_of<FeatureParameters>(),
                       .elements = {layout_of<uvec4>(), layout_of<float>(), layout_of<vec4>(), layout_of<vec4>(),
                                    layout_of<float>()}}),
      component_kernel_(device, shaders::curvature_components_comp,
                        {.push_constants = layout_of<ComponentParameters>(),
                         .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>(), layout_of<float>()}}) {
    const FeatureRuns runs = gather_runs(regression);
    const std::vector<float> weights = padded_weights(regression, padded_inputs());
    feature_count_ = runs.features.size();
    check_texels(device, std::max({feature_count_, weights.size() / 4, runs.coefficients.size() / 4, component_count_}),
                 "the coefficients of a curvature model");
    feature_table_ = Buffer::of<CurvatureFeature>(device, runs.features);
    weights_ = Buffer::of<float>(device, weights);
    features_ = Buffer(device, feature_count_ * sizeof(float));
    component_table_ = Buffer::of<CurvatureComponent>(device, runs.components);
    coefficients_ = Buffer::of<float>(device, runs.coefficients);
    components_ = Buffer(device, component_count_ * sizeof(float));
}

void GpuComponentPredictor::record(Stream& stream, const Buffer& pose, std::size_t first_input) {
    stream.dispatch(feature_kernel_, feature_count_, {feature_table_, pose, pose, weights_, features_},
                    FeatureParameters{.features = static_cast<std::uint32_t>(feature_count_),
                                      .first_input = static_cast<std::uint32_t>(first_input),
                                      .input_texels = static_cast<std::uint32_t>(input_texels_)});
    stream.dispatch(component_kernel_, component_threads_, {component_table_, coefficients_, features_, components_},
                    ComponentParameters{static_cast<std::uint32_t>(component_count_)});
}

}  // namespace exemplar
