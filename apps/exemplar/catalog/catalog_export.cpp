// exemplar catalog export and merge: a catalog as CSV or JSON; results that were made elsewhere into a catalog.

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/catalog/batch_page.h"
#include "apps/exemplar/catalog/catalog_output.h"
#include "apps/exemplar/catalog/catalog_runs.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/progress.h"
#include "host/core/text.h"
#include "host/data/catalog/worker_folder.h"
#include "host/labeling/features/feature_cache.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

struct ExportCommand {
    CommonOptions common;
    fs::path catalog, out, cache = default_feature_folder();
    std::int64_t run = 0;
};

/// One shape and, if it was labeled in the run, how.
struct ExportedRow {
    CatalogShape shape;
    const CatalogRun::Labeled* labeled;  ///< null if it was not
};

/// Calls `use` for every shape of the catalog. Both lists come in order of number, so that they run side by side.
void for_each_row(Catalog& catalog, std::optional<CatalogRun>& run,
                  const std::function<void(const ExportedRow&)>& use) {
    std::int64_t next = 0;
    const auto between = [&](std::int64_t end) {  // shapes from `next` up to but without `end`
        catalog.for_each(
            [&](const CatalogShape& shape) {
                use({shape, nullptr});
            },
            fmt::format("id >= {} AND id < {}", next, end));
    };
    if (run)
        run->for_each([&](const CatalogRun::Labeled& labeled) {
            between(labeled.shape.id);
            use({labeled.shape, &labeled});
            next = labeled.shape.id + 1;
        });
    between(std::numeric_limits<std::int64_t>::max());
}

Json describe_row(const ExportedRow& row, const fs::path& cache) {
    Json json = describe_shape_row(row.shape, cache);
    json["state"] = row.labeled ? row.labeled->state : "open";
    if (!row.labeled) return json;
    const ShapeRecord& record = row.labeled->record;
    const Json all = to_json(record);
    for (const char* key : {"model", "model_hash", "category_probability", "confidence", "labels", "seconds", "error"})
        json[key] = all[key];
    json["recognized"] = std::isnan(record.category_probability) ? std::string() : record.category;
    json["finished"] = format_time(record.finished);
    json["current"] = record.content == content_of(row.shape);
    return json;
}

/// The columns of a CSV file: those of the JSON that are no lists.
constexpr std::array k_export_columns{"id",
                                      "path",
                                      "name",
                                      "bytes",
                                      "hash",
                                      "vertices",
                                      "faces",
                                      "components",
                                      "usable",
                                      "problem",
                                      "category",
                                      "features",
                                      "state",
                                      "model",
                                      "model_hash",
                                      "recognized",
                                      "category_probability",
                                      "confidence",
                                      "labels",
                                      "seconds",
                                      "error",
                                      "finished"};

/// Shares of the labels as "head 0.12; torso 0.55"; of the stages the sum.
std::string csv_value(const std::string& column, const Json& value) {
    if (value.is_null()) return {};
    if (value.is_string()) return csv_field(value.get_ref<const std::string&>());
    if (column == "seconds" && value.is_object()) {
        double all = 0;
        for (const auto& stage : value) all += stage.is_number() ? stage.get<double>() : 0;
        return fmt::format("{:.4f}", all);
    }
    if (column == "labels" && value.is_array()) {
        std::string text;
        for (const Json& label : value)
            if (label.is_object() && label.value("label", Json()).is_string() &&
                label.value("area_share", Json()).is_number())
                text += fmt::format("{}{} {:.4f}", text.empty() ? "" : "; ", label["label"].get<std::string>(),
                                    label["area_share"].get<double>());
        return csv_field(text);
    }
    return csv_field(json_text(value));
}

void write_csv(std::ostream& out, Catalog& catalog, std::optional<CatalogRun>& run, const fs::path& cache) {
    out << fmt::format("{}\r\n", fmt::join(k_export_columns, ","));
    for_each_row(catalog, run, [&](const ExportedRow& row) {
        const Json json = describe_row(row, cache);
        std::vector<std::string> fields;
        fields.reserve(k_export_columns.size());
        for (const char* column : k_export_columns) fields.push_back(csv_value(column, json.value(column, Json())));
        out << fmt::format("{}\r\n", fmt::join(fields, ","));
    });
}

void write_json_rows(std::ostream& out, Catalog& catalog, std::optional<CatalogRun>& run, const fs::path& cache) {
    write_json_list(out, [&](const auto& write) {
        for_each_row(catalog, run, [&](const ExportedRow& row) { write(describe_row(row, cache)); });
    });
    out << '\n';
}

void run_export(const ExportCommand& options) {
    const auto limits = apply_common_options(options.common);
    const bool csv = options.out.extension() == ".csv";
    if (!csv && options.out.extension() != ".json")
        throw UsageError(options.out.string() + ": give a name that ends in .csv or .json");
    require_output_file(options.out);
    require_not_replaced(options.out, {options.catalog});
    Catalog catalog(options.catalog, Database::Open::existing);
    std::optional<CatalogRun> run = chosen_run(catalog, options.run);
    write_file_atomically(options.out, [&](std::ostream& out) {
        csv ? write_csv(out, catalog, run, options.cache) : write_json_rows(out, catalog, run, options.cache);
    });
    fmt::print("{} written to {}\n", counted(static_cast<std::size_t>(catalog.count()), "shape"), options.out.string());
}

/// Rewrites the page, but only in a folder that batch labeling has marked, as a catalog may come from anywhere.
void renew_page(Catalog& catalog, CatalogRun& run) {
    const fs::path out = run.folder().parent_path();
    std::error_code ignored;
    refuse_links(out);
    if (fs::exists(out / k_output_mark, ignored)) write_batch_page(out, catalog, run, {});
}

void run_merge(const ExportCommand& options) {
    const auto limits = apply_common_options(options.common);
    Catalog catalog(options.catalog, Database::Open::existing);
    Json merged = Json::array();
    for (const RunSummary& summary : runs_of(catalog)) {
        if (options.run > 0 && summary.id != options.run) continue;
        CatalogRun run(catalog, summary.id);
        const CatalogRun::Counts before = run.counts();
        Progress progress("looking for results", static_cast<std::size_t>(before.open + before.claimed));
        const std::size_t found = run.merge_records([&](std::size_t) { progress.advance(); });
        progress.finish();
        if (found > 0) renew_page(catalog, run);
        const CatalogRun::Counts after = run.counts();
        fmt::print("run {}: {} new; now {} labeled, {} of unknown category, {} failed, {} to do\n", summary.id,
                   counted(found, "result"), after.done, after.unknown, after.failed, after.open + after.claimed);
        merged.push_back({{"run", summary.id},
                          {"merged", found},
                          {"done", after.done},
                          {"unknown", after.unknown},
                          {"failed", after.failed},
                          {"open", after.open + after.claimed}});
    }
    if (merged.empty()) throw DataError(fmt::format("{}: nothing was labeled from it yet", options.catalog.string()));
    write_report(options.common, {{"catalog", options.catalog.string()}, {"runs", merged}});
}

void add_export_options(Command& command, ExportCommand& options) {
    command.add_option("CATALOG", options.catalog, "catalog file")->required()->type_name("");
    command.add_option("--run", options.run, "number of the labeling run, see 'exemplar catalog status'")
        ->check(whole_number(1, 1'000'000'000))
        ->type_name("N");
    add_common_options(command, options.common);
}

}  // namespace

void add_catalog_export_command(Command& catalog) {
    auto options = std::make_shared<ExportCommand>();
    Command* command = catalog.add_subcommand("export", "Writes a catalog and its labels as CSV or JSON");
    command->footer(
        "A row for every shape, with what the latest run (or --run) made of it.\n\nExample:\n"
        "  exemplar catalog export shapes.db --out shapes.csv");
    add_export_options(*command, *options);
    command->add_option("--out", options->out, "file to write, .csv or .json")->required()->type_name("FILE");
    command->add_option("--cache", options->cache, "folder that remembers features")
        ->capture_default_str()
        ->type_name("FOLDER");
    command->callback([options] { run_export(*options); });
}

void add_catalog_merge_command(Command& catalog) {
    auto options = std::make_shared<ExportCommand>();
    Command* command = catalog.add_subcommand("merge", "Takes over what was labeled elsewhere, such as on a cluster");
    command->footer(
        "Looks into the folders that runs write to, for shapes that the catalog has no result of.\n\nExample:\n"
        "  exemplar catalog merge shapes.db");
    add_export_options(*command, *options);
    command->callback([options] { run_merge(*options); });
}

}  // namespace exemplar
