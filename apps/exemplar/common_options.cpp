#include "apps/exemplar/common_options.h"

#include "apps/exemplar/arguments.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"

namespace exemplar {

void add_device_option(Command& command, CommonOptions& options) {
    command
        .add_option("--device", options.device,
                    "Vulkan device: index, part of its name, uuid:HEX or pci:ADDRESS (see 'exemplar devices')")
        ->type_name("NAME");
}

void add_common_options(Command& command, CommonOptions& options) {
    command.add_option("--threads", options.threads, "CPU threads; 0 uses all cores")
        ->capture_default_str()
        ->check(whole_number(0, 4096));
    command.add_flag("--quiet", options.quiet, "no progress and no remarks");
    command.add_option("--json", options.json, "also write the report as JSON to this file")->type_name("FILE");
}

void add_memory_option(Command& command, double& gigabytes) {
    command.add_option("--memory", gigabytes, "GB of memory to use at most; if not given, half of what there is")
        ->check(in_range(0.1, 1e6))
        ->type_name("GB");
}

std::size_t memory_of_option(double gigabytes) {
    return static_cast<std::size_t>(1e9 * gigabytes);
}

std::shared_ptr<void> apply_common_options(const CommonOptions& options) {
    require_output_file(options.json);
    Progress::set_quiet(options.quiet);
    return std::make_shared<ThreadLimit>(options.threads);
}

void write_json(const std::filesystem::path& path, const nlohmann::json& json) {
    // Names of files may be in any encoding; JSON is UTF-8, so what is not becomes U+FFFD.
    const std::string text = json_text(json, 2);
    write_file_atomically(path, [&](std::ostream& out) { out << text << '\n'; });
}

void write_report(const CommonOptions& options, const nlohmann::json& report) {
    if (!options.json.empty()) write_json(options.json, report);
}

}  // namespace exemplar
