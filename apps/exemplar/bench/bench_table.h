#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace exemplar {

/// What one run cost.
struct Cost {
    double wall = 0;  ///< seconds
    double cpu = 0;   ///< seconds of all threads
    double peak = 0;  ///< bytes of the process at most while it ran, its data included; NaN where the system cannot say
    double own = 0;   ///< what of that the process did not have before
};

/// The medians over `runs` runs. Memory that earlier work has freed is given back first, so that it does not count.
Cost measure(std::size_t runs, const std::function<void()>& run);
/// The same on one thread. The run must do its work on this process' CPU: a device has threads of its own.
Cost measure_single_thread(std::size_t runs, const std::function<void()>& run);

/// A line of the table.
struct BenchRow {
    std::string name{}, what{}, goal{}, others{};
    Cost cost{};
    std::optional<Cost> single_thread{};                ///< the same operation on one thread, without a device
    std::vector<std::string> remarks{};                 ///< what else came out, a sentence each
    nlohmann::json numbers = nlohmann::json::object();  ///< the same for programs
};

void print_header();
void print_row(const BenchRow& row);
nlohmann::json describe_row(const BenchRow& row);

/// The exponent e of value = c size^e, by least squares of the logarithms. Two sizes at least.
double fitted_exponent(const std::vector<double>& sizes, const std::vector<double>& values);

}  // namespace exemplar
