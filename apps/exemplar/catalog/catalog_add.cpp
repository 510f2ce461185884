// exemplar catalog add: finds meshes, looks into each, and keeps what it found.

#include "apps/exemplar/catalog/catalog_add.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <functional>
#include <optional>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/memory_budget.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/data/catalog/shape_scan.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_at_a_time = 256;  ///< shapes that are kept in one step, and lost if the program is killed

/// Calls `found` for every mesh of a source. Missing files of a list are included, as shapes that cannot be read.
void find_in_source(const fs::path& source, const std::function<void(const FoundShape&)>& found,
                    const SkipHandler& left_out) {
    require_input(source);
    if (fs::is_directory(source)) return find_shapes(source, found, left_out);
    for (const fs::path& path : meshes_of_argument(source, MissingMeshes::kept)) {
        const fs::path absolute = fs::absolute(path).lexically_normal();
        const fs::path relative = absolute.lexically_relative(fs::absolute(source).lexically_normal().parent_path());
        const bool below = !relative.empty() && *relative.begin() != "..";
        found({absolute, below ? relative : absolute.filename()});
    }
}

/// "scans" for scans/, ./scans and ../scans/.
fs::path name_of_source(const fs::path& source) {
    if (!fs::is_directory(source)) return {};
    const fs::path whole = fs::canonical(source);
    return whole.filename();
}

/// Reads files, several at a time, and stores what it finds in the catalog.
class Adder {
  public:
    Adder(Catalog& catalog, const AddOptions& options, std::size_t total)
        : catalog_(catalog),
          options_(options),
          memory_(options.memory ? options.memory : usable_memory() / 2),
          progress_("reading shapes", total) {}

    void add(const FoundShape& found, const fs::path& below) {
        check_interrupt();
        ++counts_.found;
        CatalogShape shape = stat_of(found.path);
        shape.name = output_name(below / found.relative);
        shape.category = options_.category_of_folder ? found.path.parent_path().filename().string() : options_.category;
        if (const auto known = catalog_.find(found.path); known && is_same(*known, shape)) {
            ++counts_.unchanged;
            progress_.advance();
            return;
        }
        waiting_.push_back(std::move(shape));
        if (waiting_.size() == k_at_a_time) flush();
    }
    AddCounts finish() {
        flush();
        progress_.finish();
        return counts_;
    }

  private:
    /// Leaves size and time at 0 if they are not available; reading then tells why.
    static CatalogShape stat_of(const fs::path& path) {
        try {
            return stat_shape(path);
        } catch (const Error&) {
            CatalogShape shape;
            shape.path = path;
            return shape;
        }
    }
    /// Unusable shapes count as changed: another user, or more memory, may make them readable.
    static bool is_same(const CatalogShape& known, const CatalogShape& now) {
        return known.problem.empty() && known.bytes == now.bytes && known.modified == now.modified &&
               (now.category.empty() || known.category == now.category);
    }
    void flush() {
        parallel_for(waiting_.size(), [&](std::size_t i) {
            // A thread that waits for memory must not start another shape, or both would wait forever.
            tbb::this_task_arena::isolate([&] { look_into(waiting_[i]); });
        });
        for (const CatalogShape& shape : waiting_) counts_.unusable += shape.problem.empty() ? 0 : 1;
        counts_.fresh += waiting_.size();
        catalog_.put(waiting_);
        waiting_.clear();
    }
    void look_into(CatalogShape& shape) {
        auto bytes = static_cast<std::uint64_t>(shape.bytes);
        const auto take = [&] { return budget_.take(std::min(reading_memory(bytes), memory_)); };
        if (reading_memory(bytes) <= memory_) {
            const MemoryBudget::Share looking = take();
            bytes += external_buffer_bytes(shape.path);
        }
        const MemoryBudget::Share share = take();
        CatalogShape described = describe_shape(shape.path, memory_);
        described.name = std::move(shape.name);
        described.category = std::move(shape.category);
        shape = std::move(described);
        progress_.advance(1, shape.path.filename().string());
    }

    Catalog& catalog_;
    const AddOptions& options_;
    std::size_t memory_;
    MemoryBudget budget_{memory_};
    Progress progress_;
    std::vector<CatalogShape> waiting_;
    AddCounts counts_;
};

}  // namespace

AddCounts add_to_catalog(Catalog& catalog, const std::vector<fs::path>& sources, const AddOptions& options) {
    std::size_t total = 0;
    const auto warn = [&](const fs::path& path, const std::string& why) {
        if (!options.quiet) fmt::print(stderr, "warning: {}: {}: left out\n", without_controls(path.string()), why);
    };
    for (const fs::path& source : sources)
        find_in_source(
            source, [&](const FoundShape&) { ++total; }, warn);
    Adder adder(catalog, options, total);
    for (const fs::path& source : sources) {
        const fs::path below = options.named_after_source ? name_of_source(source) : fs::path();
        find_in_source(
            source, [&](const FoundShape& found) { adder.add(found, below); },
            [](const fs::path&, const std::string&) {});
    }
    return adder.finish();
}

AddCounts retry_unusable(Catalog& catalog, const AddOptions& options) {
    std::vector<fs::path> paths;
    catalog.for_each([&](const CatalogShape& shape) { paths.push_back(shape.path); }, "problem <> ''");
    Adder adder(catalog, options, paths.size());
    for (const fs::path& path : paths) adder.add({path, path.filename()}, {});
    return adder.finish();
}

namespace {

struct AddCommand {
    CommonOptions common;
    fs::path catalog;
    std::vector<fs::path> sources;
    double memory = 0;
    AddOptions add;
};

void run_add(AddCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    for (const fs::path& source : options.sources) require_input(source);
    require_output_file(options.catalog);
    options.add.quiet = options.common.quiet;
    options.add.memory = memory_of_option(options.memory);
    Catalog catalog(options.catalog, Database::Open::create);
    const AddCounts counts = add_to_catalog(catalog, options.sources, options.add);
    fmt::print("{} found: {} read, {} as they were; {} of those read cannot be used{}\n",
               counted(counts.found, "shape"), counts.fresh, counts.unchanged, counts.unusable,
               counts.unusable
                   ? fmt::format(" ('exemplar catalog list {} --problems' says why)", options.catalog.string())
                   : "");
    write_report(options.common, {{"catalog", options.catalog.string()},
                                  {"found", counts.found},
                                  {"read", counts.fresh},
                                  {"unchanged", counts.unchanged},
                                  {"unusable", counts.unusable},
                                  {"seconds", watch.wall()}});
}

}  // namespace

void add_catalog_add_command(Command& catalog) {
    auto options = std::make_shared<AddCommand>();
    Command* command = catalog.add_subcommand("add", "Adds shapes to a catalog, which is made if there is none");
    command->footer(
        "Folders are searched with all folders below them. Added again, shapes that have changed are read again.\n\n"
        "Example:\n  exemplar catalog add shapes.db downloads/ scans/chair.obj\n"
        "  exemplar catalog add shapes.db psb/labeled --category-of-folder");
    command->add_option("CATALOG", options->catalog, "catalog file, such as shapes.db")->required()->type_name("");
    command->add_option("SOURCE", options->sources, "folders of meshes, lists (.txt, a path a line) or mesh files")
        ->required()
        ->type_name("");
    Option* category =
        command->add_option("--category", options->add.category, "what all of them are, say 'cup'")->type_name("NAME");
    command->add_flag("--category-of-folder", options->add.category_of_folder, "each is what its folder is called")
        ->excludes(category);
    add_memory_option(*command, options->memory);
    add_common_options(*command, options->common);
    command->callback([options] { run_add(*options); });
}

}  // namespace exemplar
