#include "apps/exemplar/label/thesis_rates.h"

#include <algorithm>
#include <array>

namespace exemplar {
namespace {

constexpr std::array<std::size_t, 4> k_thesis_training_meshes{19, 12, 6, 3};

struct ThesisRow {
    std::string_view category;
    std::array<double, 4> recognition_rate, rand_error;  ///< in percent, in the order of k_training_meshes
};
constexpr ThesisRow k_rows[] = {
    {"Human", {93.6, 93.2, 89.4, 83.2}, {11.9, 12.9, 14.3, 14.7}},
    {"Cup", {99.6, 99.6, 99.1, 96.3}, {9.9, 9.9, 10.0, 10.0}},
    {"Glasses", {97.4, 97.2, 96.1, 94.4}, {13.6, 14.1, 14.1, 14.2}},
    {"Airplane", {96.3, 96.1, 95.5, 91.2}, {7.9, 8.2, 8.0, 10.2}},
    {"Ant", {98.8, 98.8, 98.7, 97.4}, {1.9, 2.2, 2.3, 2.6}},
    {"Chair", {98.5, 98.4, 97.8, 97.1}, {5.4, 5.6, 6.1, 6.6}},
    {"Octopus", {98.4, 98.4, 98.6, 98.3}, {1.8, 1.8, 2.2, 2.2}},
    {"Table", {99.4, 99.3, 99.1, 99.0}, {6.2, 6.6, 6.4, 11.1}},
    {"Teddy", {98.1, 98.1, 93.3, 93.1}, {3.1, 3.2, 5.3, 5.6}},
    {"Hand", {90.5, 88.7, 82.4, 74.9}, {10.4, 11.2, 13.9, 15.8}},
    {"Plier", {97.0, 96.2, 94.3, 92.2}, {5.4, 9.0, 10.0, 10.5}},
    {"Fish", {96.7, 95.6, 95.6, 94.1}, {12.9, 13.2, 14.2, 13.5}},
    {"Bird", {92.5, 87.9, 84.2, 76.3}, {10.4, 14.8, 14.8, 18.6}},
    {"Armadillo", {91.9, 90.1, 84.0, 83.7}, {8.0, 8.4, 8.4, 8.6}},
    {"Bust", {67.2, 62.1, 53.9, 52.2}, {21.4, 22.2, 33.4, 39.3}},
    {"Mech", {94.6, 90.5, 88.9, 82.4}, {10.0, 11.8, 12.7, 24.0}},
    {"Bearing", {95.2, 86.6, 84.8, 61.3}, {9.7, 17.6, 21.7, 32.7}},
    {"Vase", {87.2, 85.8, 77.0, 74.3}, {16.0, 17.1, 19.9, 25.3}},
    {"FourLeg", {88.7, 86.2, 85.0, 82.0}, {13.3, 13.9, 14.7, 16.3}},
};

/// Returns whether `name` is `category`, perhaps with a suffix that starts with '-' or '_'.
bool names(std::string_view name, std::string_view category) {
    return name.starts_with(category) &&
           (name.size() == category.size() || name[category.size()] == '-' || name[category.size()] == '_');
}

}  // namespace

std::optional<ThesisRates> thesis_rates(std::string_view category, std::size_t training_meshes) {
    const auto column = std::find(k_thesis_training_meshes.begin(), k_thesis_training_meshes.end(), training_meshes);
    const auto row = std::find_if(std::begin(k_rows), std::end(k_rows),
                                  [&](const ThesisRow& candidate) { return names(category, candidate.category); });
    if (column == k_thesis_training_meshes.end() || row == std::end(k_rows)) return {};
    const auto i = static_cast<std::size_t>(column - k_thesis_training_meshes.begin());
    return ThesisRates{row->recognition_rate[i] / 100, row->rand_error[i] / 100};
}

}  // namespace exemplar
