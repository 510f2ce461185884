// exemplar catalog list and status: what a catalog holds, shape by shape and as a whole.

#include <fmt/format.h>

#include <ostream>

#include "apps/exemplar/catalog/catalog_output.h"
#include "apps/exemplar/catalog/catalog_runs.h"
#include "apps/exemplar/commands.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"
#include "host/labeling/features/feature_cache.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct ListCommand {
    CommonOptions common;
    fs::path catalog, cache = default_feature_folder();
    std::string category;
    bool problems = false, usable = false;
};

constexpr std::size_t k_max_listed_text = 200;  ///< maximum characters of a text from a file

/// An SQL condition for the shapes that are asked for.
std::string condition(const ListCommand& options) {
    std::string where = "1";
    if (options.problems) where += " AND problem <> ''";
    if (options.usable) where += " AND problem = ''";
    if (!options.category.empty()) where += " AND category = " + sql_text(options.category);
    return where;
}

void print_shape(const CatalogShape& shape) {
    const std::string path = mesh_io::printable(shape.path.string(), k_max_listed_text);
    if (!shape.problem.empty()) {
        // Most problems begin with the path.
        const std::string& problem = shape.problem;
        const bool named = problem.starts_with(shape.path.string() + ':');
        fmt::print("{:>7}  unusable  {}\n", shape.id,
                   named ? mesh_io::printable(problem, 2 * k_max_listed_text)
                         : path + ": " + mesh_io::printable(problem, k_max_listed_text));
        return;
    }
    const auto pieces = static_cast<std::size_t>(shape.components);
    fmt::print("{:>7}  {:>8} faces  {:>8} vertices  {:<10} {:<12} {}\n", shape.id, shape.faces, shape.vertices,
               counted(pieces, "piece"), mesh_io::printable(shape.category, 40), path);
}

void run_list(const ListCommand& options) {
    const auto limits = apply_common_options(options.common);
    Catalog catalog(options.catalog, Database::Open::existing);
    const std::string where = condition(options);
    if (!options.common.quiet) catalog.for_each(print_shape, where);
    if (options.common.json.empty()) return;
    write_file_atomically(options.common.json, [&](std::ostream& out) {
        out << R"({"catalog": )" << json_text(options.catalog.string()) << R"(, "shapes": )";
        write_json_list(out, [&](const auto& write) {
            catalog.for_each([&](const CatalogShape& shape) { write(describe_shape_row(shape, options.cache)); },
                             where);
        });
        out << "}\n";
    });
}

/// Counts by one column, the most frequent first.
Json count_by(Catalog& catalog, const std::string& column, const std::string& where) {
    Statement query = catalog.database().prepare(
        fmt::format("SELECT {0}, count(*) FROM shapes WHERE {1} GROUP BY {0} ORDER BY 2 DESC, 1", column, where));
    Json counts = Json::array();
    while (query.step()) counts.push_back({{column, query.text(0)}, {"shapes", query.integer(1)}});
    return counts;
}

struct CacheState {
    std::size_t cached = 0;
    std::uintmax_t bytes = 0;
};
CacheState cache_state(Catalog& catalog, const fs::path& cache) {
    CacheState state;
    catalog.for_each(
        [&](const CatalogShape& shape) {
            std::error_code error;
            const std::uintmax_t bytes = fs::file_size(cache / fs::path(shape.features).filename(), error);
            if (error) return;
            ++state.cached;
            state.bytes += bytes;
        },
        "features <> ''");
    return state;
}

void print_run(const Json& run) {
    fmt::print("run {}: {} with {}, into {}\n", run["run"].get<std::int64_t>(), run["started"].get<std::string>(),
               mesh_io::printable(run["models"].get<std::string>(), k_max_listed_text),
               mesh_io::printable(run["folder"].get<std::string>(), k_max_listed_text));
    fmt::print("    {} labeled, {} of unknown category, {} failed, {} being worked on, {} to do\n",
               run["done"].get<std::int64_t>(), run["unknown"].get<std::int64_t>(), run["failed"].get<std::int64_t>(),
               run["claimed"].get<std::int64_t>(), run["open"].get<std::int64_t>());
}

Json describe_run(Catalog& catalog, const RunSummary& run) {
    const CatalogRun::Counts counts = CatalogRun(catalog, run.id).counts();
    return {{"run", run.id},
            {"models", run.models},
            {"folder", run.folder},
            {"started", format_time(run.started)},
            {"done", counts.done},
            {"failed", counts.failed},
            {"unknown", counts.unknown},
            {"claimed", counts.claimed},
            {"open", counts.open}};
}

void run_status(const ListCommand& options) {
    const auto limits = apply_common_options(options.common);
    Catalog catalog(options.catalog, Database::Open::existing);
    const std::int64_t all = catalog.count(), unusable = catalog.count("problem <> ''");
    const CacheState features = cache_state(catalog, options.cache);
    const Json categories = count_by(catalog, "category", "problem = ''");
    fmt::print("{}: {}, {} of them unusable\n", options.catalog.string(),
               counted(static_cast<std::size_t>(all), "shape"), unusable);
    fmt::print("features remembered of {}, {:.1f} GB\n", features.cached, 1e-9 * static_cast<double>(features.bytes));
    for (const Json& category : categories)
        if (const auto name = category["category"].get<std::string>(); !name.empty())
            fmt::print("{:>8} {}\n", category["shapes"].get<std::int64_t>(),
                       mesh_io::printable(name, k_max_listed_text));
    Json runs = Json::array();
    for (const RunSummary& run : runs_of(catalog)) {
        runs.push_back(describe_run(catalog, run));
        print_run(runs.back());
    }
    write_report(options.common, {{"catalog", options.catalog.string()},
                                  {"shapes", all},
                                  {"unusable", unusable},
                                  {"features", {{"shapes", features.cached}, {"bytes", features.bytes}}},
                                  {"categories", categories},
                                  {"runs", runs}});
}

void add_list_options(Command& command, ListCommand& options) {
    command.add_option("CATALOG", options.catalog, "catalog file")->required()->type_name("");
    command.add_option("--cache", options.cache, "folder that remembers features")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_common_options(command, options.common);
}

}  // namespace

void add_catalog_list_command(Command& catalog) {
    auto options = std::make_shared<ListCommand>();
    Command* command = catalog.add_subcommand("list", "Prints a line for every shape of a catalog");
    command->footer("Example:\n  exemplar catalog list shapes.db --problems");
    add_list_options(*command, *options);
    Option* problems = command->add_flag("--problems", options->problems, "only those that cannot be used, and why");
    command->add_flag("--usable", options->usable, "only those that can be used")->excludes(problems);
    command->add_option("--category", options->category, "only those that were added with this category")
        ->type_name("NAME");
    command->callback([options] { run_list(*options); });
}

void add_catalog_status_command(Command& catalog) {
    auto options = std::make_shared<ListCommand>();
    Command* command = catalog.add_subcommand("status", "Prints what a catalog holds and how far its labeling is");
    command->footer("Example:\n  exemplar catalog status shapes.db --json status.json");
    add_list_options(*command, *options);
    command->callback([options] { run_status(*options); });
}

}  // namespace exemplar
