#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/bench/kernels/operation.h"
#include "apps/bench/kernels/timing.h"

namespace exemplar {

/// One kernel of an operation at one size.
struct KernelRow {
    std::string kernel;
    std::vector<double> milliseconds;  ///< of one run, a value per repeat
    Work work;

    double median_milliseconds() const;
    double gb_per_s() const;
    double gop_per_s() const;
};

/// An operation at one size, compared with its reference and timed.
struct Measurement {
    std::string operation, items;
    std::size_t size = 0;
    std::string refused;  ///< why the device cannot take this size; empty if it can
    std::vector<Difference> differences;
    std::vector<KernelRow> kernels;
    /// Milliseconds of kernels that only copy, or only multiply and add, timed in turns with the operation: the
    /// speed of the device at that time.
    KernelTimes references;

    bool fits() const;
};

/// A speed as shares of the device's ceilings, once the launch of a dispatch is taken from the time. The larger one
/// tells what limits a kernel.
struct Shares {
    double of_copy = 0, of_multiply_add = 0;
};
Shares shares_of(const KernelRow& row, const Ceilings& ceilings);

/// Selects kernels: all, or those whose name or operation's name matches a regular expression. Throws UsageError if
/// it is invalid or matches nothing.
class KernelFilter {
  public:
    explicit KernelFilter(const std::string& expression = "");
    bool wants(const OperationKind& kind) const;
    bool wants(const OperationKind& kind, std::string_view kernel) const;

  private:
    std::string expression_;
};

/// Prepares an operation, runs it twice and compares it with its reference. Times it unless it exceeds the device's
/// limits or differs from the reference. The ceilings tell how large the kernels for comparison must be.
Measurement measure_operation(Device& device, const OperationKind& kind, std::size_t size, const KernelFilter& filter,
                              const TimingOptions& options, const Ceilings& ceilings);

nlohmann::ordered_json to_json(const Measurement& measurement, const Device& device, const Ceilings& ceilings);

/// Reads the measurements of a file of to_json, for comparison. Throws DataError naming the file if it is no such
/// file, UsageError if it was measured on another device.
std::vector<Measurement> read_measurements(const std::filesystem::path& path, const DeviceInfo& device);

/// Times of kernels on the device of a report.
struct ReportedTimes {
    std::string device;
    std::map<std::string, double> milliseconds;  ///< of each kernel: the longest of its operations and sizes
};
/// Reads the times of a file of to_json. Throws DataError naming the file if it is no such file.
ReportedTimes read_times(const std::filesystem::path& path);

}  // namespace exemplar
