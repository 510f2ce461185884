#include "apps/exemplar/bench/bench_kernel_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {

void print_ceilings(const Device& device, const Ceilings& ceilings) {
    fmt::print(
        "{}, subgroups of {}: copies {:.1f} GB/s, multiply-adds {:.1f} GFLOP/s, shared memory {:.1f} GB/s, cached "
        "texels "
        "{:.1f} GB/s, atomics {:.2f} Gop/s, launch {:.4f} ms\n",
        device.info().name, device.info().subgroup_size, ceilings.copy_gb_per_s, ceilings.fma_gflop_per_s,
        ceilings.shared_gb_per_s, ceilings.texel_gb_per_s, ceilings.atomic_gop_per_s, 1e-3 * ceilings.launch_us);
}

void print_kernel_rows(const Measurement& measurement, const Ceilings& ceilings) {
    fmt::print("    {:<34}{:>10}{:>7}{:>10}{:>9}{:>8}{:>10}{:>9}{:>8}\n", "kernel", "ms", "+-%", "MB", "GB/s", "copy",
               "Mop", "Gop/s", "fma");
    for (const KernelRow& row : measurement.kernels) {
        const Shares shares = shares_of(row, ceilings);
        fmt::print("    {:<34}{:>10.4f}{:>7.1f}{:>10.3f}{:>9.2f}{:>7.1f}%{:>10.3f}{:>9.2f}{:>7.1f}%\n", row.kernel,
                   row.median_milliseconds(), 100 * relative_error(row.milliseconds), 1e-6 * row.work.bytes,
                   row.gb_per_s(), 100 * shares.of_copy, 1e-6 * row.work.operations, row.gop_per_s(),
                   100 * shares.of_multiply_add);
    }
    constexpr double k_large_share = 0.1;
    for (const KernelRow& row : measurement.kernels)
        if (const double share = 1e-3 * ceilings.launch_us / row.median_milliseconds(); share > k_large_share)
            fmt::print("    {}: the launch alone takes {:.0f}% of its time\n", row.kernel,
                       std::min(100.0, 100 * share));
}

std::string statistics_text(const std::vector<ExecutableStatistic>& statistics) {
    std::string text;
    for (const ExecutableStatistic& statistic : statistics)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", statistic.name, statistic.value);
    return text;
}

void print_driver_statistics(const Device& device, const std::vector<Measurement>& measurements) {
    std::vector<std::string> seen;
    for (const Measurement& measurement : measurements)
        for (const KernelRow& row : measurement.kernels) {
            if (std::ranges::find(seen, row.kernel) != seen.end()) continue;
            seen.push_back(row.kernel);
            const std::string text = statistics_text(device.statistics_of(row.kernel));
            if (text.empty()) continue;
            if (seen.size() == 1) fmt::print("\nWhat the driver says of its code:\n");
            fmt::print("    {:<34}{}\n", row.kernel, text);
        }
}

void compare_with_earlier(const std::vector<Measurement>& now, const std::vector<Measurement>& before) {
    const std::vector<Change> changes = changes_between(now, before);
    if (changes.empty()) throw UsageError("the baseline has none of the kernels and sizes that were measured");
    fmt::print("\nAgainst the baseline (1.00: as fast; less is faster; the device's own drift is taken away):\n");
    std::size_t slower = 0;
    for (const Change& change : changes) {
        const bool is_slower = change.ratio.is_slower();
        slower += is_slower;
        fmt::print("    {:<34}{:<28}{:>9}  {:.2f} +- {:.2f}  (drift {:.2f}){}\n", change.kernel, change.operation,
                   change.size, change.ratio.value, change.ratio.error * change.ratio.value, change.drift,
                   is_slower                  ? "  SLOWER"
                   : change.ratio.is_faster() ? "  faster"
                                              : "");
    }
    if (slower > 0)
        throw Error(fmt::format("{} of {} kernels are slower than in the baseline, by more than noise and a twentieth",
                                slower, changes.size()));
}

}  // namespace exemplar
