#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace exemplar {

/// Time and memory of one run.
struct Cost {
    double wall = 0;  ///< seconds
    double cpu = 0;   ///< seconds of all threads
    double peak = 0;  ///< maximum bytes of the process in the run, its data included; NaN if the system cannot tell
    double own = 0;   ///< the part of `peak` that the process did not have before
};

/// Returns the medians over `runs` runs. First returns freed memory to the system, so that it does not count.
Cost measure(std::size_t runs, const std::function<void()>& run);
/// The same on one thread. The run must compute on the host, as a device has threads of its own.
Cost measure_single_thread(std::size_t runs, const std::function<void()>& run);

/// A line of the table.
struct BenchRow {
    std::string name{}, what{}, goal{}, others{};
    Cost cost{};
    std::optional<Cost> single_thread{};                ///< the same operation on one thread, without a device
    std::vector<std::string> remarks{};                 ///< further results, a sentence each
    nlohmann::json numbers = nlohmann::json::object();  ///< the same for programs
};

void print_header();
void print_row(const BenchRow& row);
nlohmann::json describe_row(const BenchRow& row);

/// Returns the exponent e of value = c size^e, by least squares of the logarithms. Needs at least two sizes.
double fitted_exponent(const std::vector<double>& sizes, const std::vector<double>& values);

}  // namespace exemplar
