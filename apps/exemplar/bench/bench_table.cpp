#include "apps/exemplar/bench/bench_table.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/core/stopwatch.h"

namespace exemplar {
namespace {

/// Makes the system forget the largest memory use so far; false where it cannot.
bool reset_peak() {
    malloc_trim(0);
    std::ofstream file("/proc/self/clear_refs");
    file << "5" << std::flush;
    return file.good();
}

/// A line of the process' status in bytes: "VmHWM" is the largest memory use since reset_peak, "VmRSS" that of now.
double memory(const std::string& line) {
    std::ifstream file("/proc/self/status");
    for (std::string word; file >> word;) {
        if (word != line + ":") continue;
        double kilobytes = 0;
        file >> kilobytes;
        return 1024 * kilobytes;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

std::string format_time(double seconds) {
    if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
    return seconds < 100 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

std::string format_memory(double bytes) {
    if (std::isnan(bytes)) return "-";
    return bytes < 1e9 ? fmt::format("{:.0f} MB", 1e-6 * bytes) : fmt::format("{:.2f} GB", 1e-9 * bytes);
}

void print_cost(const std::string& what, const Cost& cost) {
    fmt::print("{:<58} {:>9} {:>9} {:>9}\n", what, format_time(cost.wall), format_time(cost.cpu),
               format_memory(cost.peak));
}

nlohmann::json describe_cost(const Cost& cost) {
    nlohmann::json json{{"wall_seconds", cost.wall}, {"cpu_seconds", cost.cpu}};
    if (!std::isnan(cost.peak)) json["peak_bytes"] = cost.peak, json["own_bytes"] = cost.own;
    return json;
}

}  // namespace

Cost measure(std::size_t runs, const std::function<void()>& run) {
    std::vector<double> wall, cpu, peak, own;
    for (std::size_t i = 0; i < runs; ++i) {
        check_interrupt();
        const bool has_peak = reset_peak();
        const double before = memory("VmRSS");
        const Stopwatch watch;
        run();
        wall.push_back(watch.wall());
        cpu.push_back(watch.cpu());
        peak.push_back(has_peak ? memory("VmHWM") : std::numeric_limits<double>::quiet_NaN());
        own.push_back(peak.back() - before);
    }
    return {median(std::span(wall)), median(std::span(cpu)), median(std::span(peak)), median(std::span(own))};
}

Cost measure_single_thread(std::size_t runs, const std::function<void()>& run) {
    const ThreadLimit limit(1);
    return measure(runs, run);
}

void print_header() {
    fmt::print("{:<58} {:>9} {:>9} {:>9}\n", "what", "wall", "CPU", "peak");
}

void print_row(const BenchRow& row) {
    print_cost(fmt::format("{}: {}", row.name, row.what), row.cost);
    if (row.single_thread) print_cost("    plain, one thread", *row.single_thread);
    if (!row.goal.empty()) fmt::print("    goal: {}\n", row.goal);
    if (!row.others.empty()) fmt::print("    others: {}\n", row.others);
    for (const std::string& remark : row.remarks) fmt::print("    {}\n", remark);
    std::fflush(stdout);
}

nlohmann::json describe_row(const BenchRow& row) {
    nlohmann::json json{{"name", row.name}, {"what", row.what}, {"measured", describe_cost(row.cost)}};
    if (row.single_thread) json["single_thread"] = describe_cost(*row.single_thread);
    if (!row.goal.empty()) json["goal"] = row.goal;
    if (!row.others.empty()) json["others"] = row.others;
    if (!row.remarks.empty()) json["remarks"] = row.remarks;
    if (!row.numbers.empty()) json["numbers"] = row.numbers;
    return json;
}

double fitted_exponent(const std::vector<double>& sizes, const std::vector<double>& values) {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double u = std::log(sizes[i]), v = std::log(values[i]);
        x += u, y += v, xx += u * u, xy += u * v;
    }
    const auto n = static_cast<double>(sizes.size());
    return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace exemplar
