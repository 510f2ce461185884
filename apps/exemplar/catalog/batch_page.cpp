#include "apps/exemplar/catalog/batch_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

#include "apps/exemplar/catalog/catalog_runs.h"
#include "apps/exemplar/shown_shapes.h"
#include "apps/report/report_page.h"
#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/data/catalog/run_summary.h"
#include "host/data/catalog/worker_folder.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

using TableRow = std::vector<std::string>;

constexpr const char* k_page = "index.html";

// Bounds of what is shown: a mesh of 5,000 faces takes 80 kB of the page, a row of a table at most 2 kB.
constexpr std::size_t k_max_views = 48, k_views_per_category = 6, k_max_shown_faces = 5000;
constexpr std::int64_t k_max_read_faces = 200'000;  ///< of a shape that is to be shown: each is read and simplified
constexpr std::size_t k_max_rows = 200, k_uncertain_rows = 50, k_max_labels = 255;
constexpr std::size_t k_max_text = 300;  ///< bytes of a name or an error

std::string shown_text(const std::string& text) {
    return mesh_io::printable(text, k_max_text);
}
std::string percent_of(double share) {
    return std::isnan(share) ? "–" : fmt::format("{:.1f} %", 100 * share);
}
std::string grouped(std::int64_t count) {
    std::string digits = std::to_string(count);
    for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, 1, ',');
    return digits;
}
std::string title_of(const CategorySummary& category) {
    return category.category.empty() ? "no category" : shown_text(category.category);
}

/// Returns a note on the full length of a list that was cut off.
std::string and_more(std::size_t shown_rows, std::int64_t all) {
    const std::int64_t more = all - static_cast<std::int64_t>(shown_rows);
    return more > 0 ? fmt::format(" The first {} are shown; there are {} more.", shown_rows, grouped(more)) : "";
}

// ---- tables

ReportTable stage_table(const std::vector<StageStatistics>& stages) {
    ReportTable table{"Stages", "", {"Stage", "Workers", "Busy", "A shape", "Shapes"}, {}};
    for (const StageStatistics& stage : stages)
        table.rows.push_back(
            {stage.name, std::to_string(stage.workers), percent_of(stage.load),
             fmt::format("{:.3f} s", stage.busy / static_cast<double>(std::max<std::size_t>(stage.items, 1))),
             grouped(static_cast<std::int64_t>(stage.items))});
    const auto slowest = std::ranges::max_element(stages, {}, &StageStatistics::load);
    table.note =
        fmt::format("Of the last call, whose stages work at the same time. The slowest was {}.", slowest->name);
    return table;
}

ReportTable time_table(const std::vector<StageSummary>& stages) {
    double all = 0;
    for (const StageSummary& stage : stages) all += stage.seconds;
    ReportTable table{"Time a shape takes",
                      "Means over all calls; in sum, stages that work at once count each.",
                      {"Stage", "A shape", "Of all time", "Shapes"},
                      {}};
    for (const StageSummary& stage : stages)
        table.rows.push_back({shown_text(stage.stage),
                              fmt::format("{:.3f} s", stage.seconds / static_cast<double>(stage.shapes)),
                              percent_of(stage.seconds / all), grouped(stage.shapes)});
    return table;
}

ReportTable category_table(const std::vector<CategorySummary>& categories) {
    ReportTable table{"Categories",
                      "Those with most labeled shapes first.",
                      {"Category", "Model", "Labeled", "Recognized", "Unknown", "Failed", "Confidence"},
                      {}};
    if (categories.size() == k_max_rows) table.note += fmt::format(" Only {} are shown.", k_max_rows);
    for (const CategorySummary& category : categories)
        table.rows.push_back({title_of(category), shown_text(category.model), grouped(category.done),
                              grouped(category.recognized), grouped(category.unknown), grouped(category.failed),
                              percent_of(category.confidence)});
    return table;
}

ReportTable label_table(const std::vector<LabelSummary>& labels, const std::string& category) {
    ReportTable table{category.empty() ? "Labels" : "Labels of " + shown_text(category),
                      "Area: mean share of a shape's surface. Confidence: where the label is.",
                      {"Label", "Area", "Confidence", "Shapes that have it"},
                      {}};
    for (const LabelSummary& label : labels)
        table.rows.push_back(
            {shown_text(label.label), percent_of(label.area), percent_of(label.confidence), grouped(label.shapes)});
    return table;
}

/// Returns the shapes whose numbers `choice`, an SQL query on the run's labels, selects.
std::vector<CatalogRun::Labeled> chosen_shapes(CatalogRun& run, const std::string& choice) {
    std::vector<CatalogRun::Labeled> shapes;
    run.for_each([&](const CatalogRun::Labeled& shape) { shapes.push_back(shape); },
                 fmt::format("labels.shape IN (SELECT shape FROM labels WHERE run = {} AND {})", run.id(), choice));
    return shapes;
}

ReportTable failure_table(CatalogRun& run, std::int64_t all) {
    const std::vector<CatalogRun::Labeled> shapes =
        chosen_shapes(run, fmt::format("state IN ('failed', 'unknown') ORDER BY shape LIMIT {}", k_max_rows));
    ReportTable table{"Not labeled",
                      "'label batch' with --retry tries these again." + and_more(shapes.size(), all),
                      {"Shape", "Why"},
                      {}};
    for (const CatalogRun::Labeled& shape : shapes)
        table.rows.push_back({shown_text(shape.shape.name), shown_text(shape.record.error)});
    return table;
}

ReportTable problem_table(Catalog& catalog, std::int64_t all) {
    ReportTable table{"Unusable files", "", {"File", "Why"}, {}};
    catalog.for_each(
        [&](const CatalogShape& shape) {
            table.rows.push_back({shown_text(shape.path.string()), shown_text(shape.problem)});
        },
        fmt::format("id IN (SELECT id FROM shapes WHERE problem <> '' ORDER BY id LIMIT {})", k_max_rows));
    table.note = "Not taken up for labeling." + and_more(table.rows.size(), all);
    return table;
}

ReportTable least_sure_table(CatalogRun& run) {
    std::vector<CatalogRun::Labeled> shapes =
        chosen_shapes(run, fmt::format("state = 'done' ORDER BY confidence, shape LIMIT {}", k_uncertain_rows));
    std::ranges::stable_sort(shapes, {}, [](const auto& shape) { return shape.record.confidence; });
    ReportTable table{"Least sure",
                      "Labeled shapes whose labels are the least probable ones: look at these first.",
                      {"Shape", "Confidence", "Category", "File"},
                      {}};
    for (const CatalogRun::Labeled& shape : shapes)
        table.rows.push_back({shown_text(shape.shape.name), percent_of(shape.record.confidence),
                              shown_text(shape.record.category), shown_text(shape.shape.path.string())});
    return table;
}

// ---- shapes to turn

/// Returns the index in the group of each label name, adding new names; -1 if the group is full.
std::vector<std::int32_t> label_numbers(const std::vector<std::string>& names, ReportData& group) {
    std::vector<std::int32_t> numbers;
    for (const std::string& foreign : names) {
        const std::string name = shown_text(foreign);
        const auto known = std::ranges::find(group.label_names, name);
        const auto number = static_cast<std::size_t>(known - group.label_names.begin());
        numbers.push_back(number < k_max_labels ? static_cast<std::int32_t>(number) : -1);
        if (known != group.label_names.end() || number >= k_max_labels) continue;
        group.label_names.push_back(name);
        group.label_colors.push_back(label_color(number));
    }
    return numbers;
}

/// Adds a mesh to the group, which refers to `shape`.
void add_mesh(ReportData& group, const ShownShape& shape, const CatalogRun::Labeled& labeled) {
    const std::vector<std::int32_t> number = label_numbers(shape.labels.names, group);
    ReportMesh mesh;
    mesh.name = fmt::format("{} ({})", shown_text(labeled.shape.name), percent_of(labeled.record.confidence));
    mesh.mesh = &shape.mesh;
    mesh.confidence = shape.confidence;
    mesh.recognition_rate = std::nan("");
    for (const std::int32_t label : shape.labels.label)
        mesh.predicted.push_back(number[static_cast<std::size_t>(label)]);
    if (std::ranges::find(mesh.predicted, -1) == mesh.predicted.end()) group.meshes.push_back(std::move(mesh));
}

/// Adds views of examples of a category, the least sure first; their meshes are kept in `meshes`.
void add_views(Catalog& catalog, CatalogRun& run, const std::string& category, std::size_t views,
               std::deque<ShownShape>& meshes, ReportData& group) {
    const std::size_t uncertain = (views + 1) / 2;
    for (const std::int64_t id :
         example_shapes(catalog, run.id(), category, uncertain, views - uncertain, k_max_read_faces))
        run.for_each(
            [&](const CatalogRun::Labeled& labeled) {
                const std::filesystem::path labels = run.record_path(labeled.shape).replace_extension(".ply");
                std::optional<ShownShape> shape = read_shown_shape(labels, k_max_shown_faces);
                if (shape) add_mesh(group, meshes.emplace_back(std::move(*shape)), labeled);
            },
            fmt::format("labels.shape = {}", id));
}

// ---- groups

void add_figures(const CatalogRun::Counts& counts, std::int64_t unusable, double confidence, const BatchReport& report,
                 ReportData& group) {
    auto& figures = group.summary;
    figures.emplace_back("labeled", grouped(counts.done));
    figures.emplace_back("of unknown category", grouped(counts.unknown));
    figures.emplace_back("failed", grouped(counts.failed));
    figures.emplace_back("unusable", grouped(unusable));
    figures.emplace_back("to do", grouped(counts.open + counts.claimed));
    figures.emplace_back("mean confidence", percent_of(confidence));
    if (report.shapes == 0) return;
    figures.emplace_back(
        fmt::format("a second, {} in {}", counted(report.shapes, "shape"), format_seconds(report.seconds)),
        fmt::format("{:.2f}", static_cast<double>(report.shapes) / std::max(report.seconds, 1e-9)));
}

std::string batch_subtitle(Catalog& catalog, const CatalogRun& run, double last_finished) {
    const std::vector<RunSummary> runs = runs_of(catalog);
    const auto summary = std::ranges::find(runs, run.id(), &RunSummary::id);
    std::string text = fmt::format("Labeled by {} into {}, begun {}", shown_text(summary->models),
                                   shown_text(summary->folder), format_time(summary->started));
    if (!std::isnan(last_finished)) text += fmt::format(", the latest shape done {}", format_time(last_finished));
    return text + " (UTC)";
}

ReportData overview(Catalog& catalog, CatalogRun& run, const BatchReport& report,
                    const std::vector<CategorySummary>& categories) {
    const CatalogRun::Counts counts = run.counts();
    const std::int64_t unusable = catalog.count("problem <> ''"), failed = counts.failed + counts.unknown;
    const RunTotals totals = summarize_run(catalog, run.id());
    ReportData group;
    group.title = "Overview";
    group.subtitle = batch_subtitle(catalog, run, totals.last_finished);
    add_figures(counts, unusable, totals.confidence, report, group);
    if (!categories.empty()) group.tables.push_back(category_table(categories));
    if (failed > 0) group.tables.push_back(failure_table(run, failed));
    if (unusable > 0) group.tables.push_back(problem_table(catalog, unusable));
    if (counts.done > 0) group.tables.push_back(least_sure_table(run));
    if (report.shapes > 0 && !report.stages.empty()) group.tables.push_back(stage_table(report.stages));
    if (const auto stages = summarize_stages(catalog, run.id()); !stages.empty())
        group.tables.push_back(time_table(stages));
    return group;
}

ReportData category_group(Catalog& catalog, CatalogRun& run, const CategorySummary& category, std::size_t views,
                          std::deque<ShownShape>& meshes) {
    ReportData group;
    group.title = title_of(category);
    group.subtitle =
        fmt::format("{} labeled by the model {}; shown are the least sure ones, then others up to the surest",
                    counted(static_cast<std::size_t>(category.done), "shape"), shown_text(category.model));
    group.summary = {{"labeled", grouped(category.done)}, {"mean confidence", percent_of(category.confidence)}};
    if (category.recognized > 0) group.summary.emplace_back("recognized as such", grouped(category.recognized));
    group.tables.push_back(
        label_table(summarize_labels(catalog, run.id(), category.category, k_max_rows), category.category));
    add_views(catalog, run, category.category, views, meshes, group);
    return group;
}

/// Joins a single category with the overview into one group.
void join_into_overview(std::vector<ReportData>& groups) {
    ReportData only = std::move(groups.back());
    groups.pop_back();
    ReportData& group = groups.front();
    group.label_names = std::move(only.label_names);
    group.label_colors = std::move(only.label_colors);
    group.meshes = std::move(only.meshes);
    group.tables.insert(group.tables.begin(), only.tables.begin(), only.tables.end());
}

}  // namespace

void write_batch_page(const std::filesystem::path& out, Catalog& catalog, CatalogRun& run, const BatchReport& report) {
    const std::vector<CategorySummary> categories = summarize_categories(catalog, run.id(), k_max_rows);
    const auto labeled = static_cast<std::size_t>(
        std::ranges::count_if(categories, [](const CategorySummary& category) { return category.done > 0; }));
    const std::size_t shown_categories = std::min(labeled, k_max_views);
    const std::size_t views =
        std::clamp<std::size_t>(k_max_views / std::max<std::size_t>(labeled, 1), 1, k_views_per_category);
    std::deque<ShownShape> meshes;
    std::vector<ReportData> groups{overview(catalog, run, report, categories)};
    for (std::size_t c = 0; c < shown_categories; ++c)
        groups.push_back(category_group(catalog, run, categories[c], views, meshes));
    if (groups.size() == 2) join_into_overview(groups);
    const WorkerFolder worker(out);  // the next program removes a partial page of a killed one
    write_report_page(worker.path() / k_page, "Labeled shapes", groups);
    std::error_code error;
    std::filesystem::rename(worker.path() / k_page, out / k_page, error);
    if (error) throw DataError(fmt::format("{}: cannot be written: {}", (out / k_page).string(), error.message()));
}

}  // namespace exemplar
