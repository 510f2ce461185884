#include "host/data/catalog/run_summary.h"

namespace exemplar {
namespace {

std::int64_t limit(std::size_t most) {
    return static_cast<std::int64_t>(most);
}

}  // namespace

std::vector<CategorySummary> summarize_categories(Catalog& catalog, std::int64_t run, std::size_t most) {
    Statement query = catalog.database().prepare(
        "SELECT coalesce(category, ''), max(model), sum(state = 'done'), sum(state = 'failed'), sum(state = "
        "'unknown'), "
        "sum(state = 'done' AND category_probability IS NOT NULL), avg(CASE WHEN state = 'done' THEN confidence END) "
        "FROM labels WHERE run = ? AND state <> 'claimed' GROUP BY 1 ORDER BY 3 DESC, 1 LIMIT ?");
    query.bind(run, limit(most));
    std::vector<CategorySummary> categories;
    while (query.step())
        categories.push_back({.category = query.text(0),
                              .model = query.text(1),
                              .done = query.integer(2),
                              .failed = query.integer(3),
                              .unknown = query.integer(4),
                              .recognized = query.integer(5),
                              .confidence = query.real(6)});
    return categories;
}

std::vector<LabelSummary> summarize_labels(Catalog& catalog, std::int64_t run, const std::string& category,
                                           std::size_t most) {
    // Values that are no numbers or no lists were not written by this program; they are skipped.
    Statement query = catalog.database().prepare(
        "WITH chosen AS (SELECT labels AS list FROM labels WHERE run = ?1 AND state = 'done' "
        "AND coalesce(category, '') = ?2) "
        "SELECT json_extract(part.value, '$.label'), count(*), sum(json_extract(part.value, '$.area_share')), "
        "avg(json_extract(part.value, '$.confidence')), (SELECT count(*) FROM chosen) "
        "FROM chosen, json_each(CASE WHEN json_valid(list) THEN list ELSE '[]' END) AS part "
        "WHERE part.type = 'object' GROUP BY 1 ORDER BY 3 DESC, 1 LIMIT ?3");
    query.bind(run, category, limit(most));
    std::vector<LabelSummary> labels;
    while (query.step())
        labels.push_back({.label = query.text(0),
                          .shapes = query.integer(1),
                          .area = query.real(2) / query.real(4),
                          .confidence = query.real(3)});
    return labels;
}

std::vector<StageSummary> summarize_stages(Catalog& catalog, std::int64_t run) {
    constexpr std::size_t k_most = 100;
    Statement query = catalog.database().prepare(
        "SELECT stage.key, count(*), sum(stage.value) FROM labels, "
        "json_each(CASE WHEN json_valid(seconds) THEN seconds ELSE '{}' END) AS stage "
        "WHERE run = ? AND state <> 'claimed' GROUP BY 1 ORDER BY 3 DESC, 1 LIMIT ?");
    query.bind(run, limit(k_most));
    std::vector<StageSummary> stages;
    while (query.step()) stages.push_back({query.text(0), query.integer(1), query.real(2)});
    return stages;
}

RunTotals summarize_run(Catalog& catalog, std::int64_t run) {
    Statement query = catalog.database().prepare(
        "SELECT avg(CASE WHEN state = 'done' THEN confidence END), max(finished) FROM labels WHERE run = ?");
    if (!query.bind(run).step()) return {};
    return {query.real(0), query.real(1)};
}

std::vector<std::int64_t> example_shapes(Catalog& catalog, std::int64_t run, const std::string& category,
                                         std::size_t uncertain, std::size_t others, std::int64_t max_faces) {
    // In order of confidence, the k-th of n others has rank uncertain + (all - uncertain) k / n.
    Statement query = catalog.database().prepare(
        "WITH ranked AS (SELECT shape, row_number() OVER (ORDER BY confidence, shape) AS rank, count(*) OVER () AS n "
        "FROM labels JOIN shapes ON shapes.id = shape WHERE run = ?1 AND state = 'done' "
        "AND coalesce(labels.category, '') = ?2 AND faces <= ?3), "
        "steps(k) AS (SELECT 1 WHERE ?5 > 0 UNION ALL SELECT k + 1 FROM steps WHERE k < ?5) "
        "SELECT shape FROM ranked WHERE rank <= ?4 OR rank IN (SELECT ?4 + (n - ?4) * k / ?5 FROM steps) "
        "ORDER BY rank");
    query.bind(run, category, max_faces, limit(uncertain), limit(others));
    std::vector<std::int64_t> shapes;
    while (query.step()) shapes.push_back(query.integer(0));
    return shapes;
}

}  // namespace exemplar
