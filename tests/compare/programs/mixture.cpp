// Learns the mixture of rules that directions of strokes follow, so that it can be compared with other mixtures.
//   compare_mixture IN OUT
// IN, a safetensors file, of samples: fields (35 x rows x 2, vectors of doubled angle), direction (rows x 2), place
// (rows x 2, I32: pixels), level (rows, U8: 2 where strokes cross) and spacing (rows). OUT: predicted (rules x rows x
// 2), the direction that each rule says, where a second direction counts as a rule, and rule (rows, I32), the one of a
// sample.

#include <fmt/format.h>

#include <exception>
#include <vector>

#include "host/core/errors.h"
#include "host/data/safetensors.h"
#include "host/hatching/rules/orientation_mixture.h"

namespace exemplar {
namespace {

std::vector<DoubledAngle> doubled_angles(const std::vector<float>& values) {
    std::vector<DoubledAngle> result(values.size() / 2);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = {values[2 * i], values[2 * i + 1]};
    return result;
}

OrientationSamples samples_of(const TensorFile& file) {
    const std::size_t rows = file.tensors.at("level").shape.at(0);
    OrientationSamples samples;
    for (const std::int32_t value : file.get<std::int32_t>("place", {rows, 2})) {
        std::vector<std::uint16_t>& along = samples.x.size() > samples.y.size() ? samples.y : samples.x;
        along.push_back(static_cast<std::uint16_t>(value));
    }
    samples.direction = doubled_angles(file.get<float>("direction", {rows, 2}));
    samples.level = file.get<std::uint8_t>("level", {rows});
    samples.spacing = file.get<float>("spacing", {rows});
    samples.fields = OrientationFields(rows);
    samples.fields.values = doubled_angles(file.get<float>("fields", {k_orientation_fields, rows, 2}));
    return samples;
}

void learn(const char* in, const char* out) {
    const OrientationSamples samples = samples_of(read_safetensors(in));
    const OrientationMixture mixture = learn_mixture(samples);
    std::vector<float> predicted;
    std::vector<std::int32_t> rule(samples.size());
    std::vector<float> nearest(samples.size(), 5);  // squared distances are at most 4
    std::int32_t rules = 0;
    for (std::size_t segment = 0; segment < mixture.rules.size(); ++segment) {
        for (const OrientationFunction& function : mixture.rules[segment].function) {
            if (function.terms.empty()) continue;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const DoubledAngle said = function.evaluate(samples.fields, i);
                predicted.insert(predicted.end(), said.begin(), said.end());
                const float distance = squared_distance(said, samples.direction[i]);
                if (mixture.segment[i] != segment || distance >= nearest[i]) continue;
                nearest[i] = distance;
                rule[i] = rules;
            }
            ++rules;
        }
    }
    TensorFile result;
    result.add("predicted", {static_cast<std::size_t>(rules), samples.size(), 2}, predicted);
    result.add("rule", {samples.size()}, rule);
    write_safetensors(out, result);
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    try {
        if (count != 3) throw exemplar::UsageError("expected 2 arguments, see the head of mixture.cpp");
        exemplar::learn(arguments[1], arguments[2]);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
