#include "apps/exemplar/label/evaluation_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "apps/exemplar/label/evaluation_summary.h"
#include "apps/exemplar/label/learning_run.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

constexpr std::size_t k_worst_meshes = 4;  ///< shown beside one of middling quality and the best

std::vector<ReportMeasure> measures_of(const Json& rates) {
    std::vector<ReportMeasure> measures;
    const Json thesis = rates.value("thesis", Json::object());
    for (const Rate& rate : evaluation_rates())
        measures.push_back(
            {rate.title, rate_of(rates, rate.key), rate_of(thesis, rate.key), rate.lower_is_better, rate.share});
    return measures;
}

std::string evaluation_subtitle(const Json& splits) {
    std::string text =
        fmt::format("{} training meshes, {} unseen meshes", splits[0]["train"].size(), splits[0]["meshes"].size());
    if (splits.size() > 1)
        text += fmt::format("; {} splits, of which the first is shown and the rates are the mean", splits.size());
    if (!splits[0].contains("shared_labels")) return text;
    const auto shared = splits[0]["shared_labels"].get<std::vector<std::string>>();
    return text + (shared.empty() ? "; they have no label name in common"
                                  : fmt::format("; rated by the labels of both: {}", fmt::join(shared, ", ")));
}

std::vector<std::pair<std::string, std::size_t>> stumps_of_families(const Json& stage) {
    std::vector<std::pair<std::string, std::size_t>> families;
    for (const auto& [family, share] : stage["share_per_family"].items())
        families.emplace_back(family, std::llround(share.get<double>() * stage["stumps"].get<double>()));
    std::stable_sort(families.begin(), families.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return families;
}

/// The features that the classifiers of a split use, by stage and in all.
void add_features(const Json& split, ReportData& group) {
    for (const Json& stage : split["features"]) {
        group.stage_features.push_back({stage["stage"], stumps_of_families(stage)});
        for (const auto& [family, count] : group.stage_features.back().families) {
            const auto known = std::find_if(group.feature_families.begin(), group.feature_families.end(),
                                            [&name = family](const auto& entry) { return entry.first == name; });
            if (known == group.feature_families.end())
                group.feature_families.emplace_back(family, count);
            else
                known->second += count;
        }
    }
    std::stable_sort(group.feature_families.begin(), group.feature_families.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    if (const Json& first = split["training"]["first_features"]; first.is_array())
        group.first_features = first.get<std::vector<std::string>>();
}

void add_curves(const Json& training, ReportData& group) {
    for (const Json& classifier : training["classifiers"]) {
        ReportCurve curve{classifier["classifier"], {}, classifier["stumps"], classifier["kept"]};
        for (const Json& point : classifier["curve"])
            curve.points.push_back({point["rounds"], rate_of(point, "loss"), rate_of(point, "error")});
        group.curves.push_back(std::move(curve));
    }
}

void add_timings(const Json& split, ReportData& group) {
    const Json& training = split["training"];
    group.timings.emplace_back("features of the training meshes", training["seconds"]["features"]);
    for (const Json& classifier : training["classifiers"])
        group.timings.emplace_back(fmt::format("training {}", classifier["classifier"].get<std::string>()),
                                   classifier["seconds"]);
    group.timings.emplace_back("training the CRF", training["crf"]["seconds"]);
    group.timings.emplace_back("training, all", training["seconds"]["all"]);
    const std::pair<const char*, const char*> stages[] = {{"features", "a test mesh: features"},
                                                          {"unary", "a test mesh: unary classifiers"},
                                                          {"pairwise", "a test mesh: pairwise classifiers"},
                                                          {"cut", "a test mesh: graph cut"}};
    for (const auto& [stage, title] : stages) {
        double sum = 0;
        for (const Json& mesh : split["meshes"]) sum += mesh["seconds"].value(stage, 0.0);
        group.timings.emplace_back(title, sum / static_cast<double>(split["meshes"].size()));
    }
}

}  // namespace

ReportData report_group(const Json& category) {
    const Json& splits = category["splits"];
    ReportData group;
    group.title = category["category"];
    group.subtitle = evaluation_subtitle(splits);
    group.label_names = category["names"].get<std::vector<std::string>>();
    for (std::size_t c = 0; c < group.label_names.size(); ++c) group.label_colors.push_back(label_color(c));
    group.recognition_rate = rate_of(category, "recognition_rate");
    group.confusion = category["confusion"].get<std::vector<double>>();
    group.measures = measures_of(category);
    group.reference_name = "thesis";
    for (const Json& split : splits)
        for (const Json& mesh : split["meshes"]) {
            const std::string name = mesh["mesh"];
            group.scores.push_back(
                {splits.size() > 1 ? split["split"].get<std::string>() + "/" + name : name, measures_of(mesh)});
        }
    add_features(splits[0], group);
    add_curves(splits[0]["training"], group);
    add_timings(splits[0], group);
    for (const Rate& rate : evaluation_rates().first(4))
        if (const double value = rate_of(category, rate.key); !std::isnan(value))
            group.summary.emplace_back(rate.title, fmt::format("{:.1f} %", 100 * value));
    if (splits[0].contains("learning_curve"))
        group.summary.emplace_back("Learning curve", learning_curve_text(splits[0]["learning_curve"]));
    return group;
}

std::vector<std::size_t> shown_meshes(const Json& split) {
    const Json& meshes = split["meshes"];
    const auto badness = [&](std::size_t i) {
        const double rate = rate_of(meshes[i], "recognition_rate"), error = rate_of(meshes[i], "rand_error");
        return !std::isnan(rate) ? -rate : std::isnan(error) ? 0 : error;
    };
    std::vector<std::size_t> order(meshes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return badness(a) > badness(b); });
    if (order.size() <= k_worst_meshes + 2) return order;
    std::vector<std::size_t> shown(order.begin(), order.begin() + k_worst_meshes);
    shown.push_back(order[(k_worst_meshes + order.size()) / 2]);
    shown.push_back(order.back());
    return shown;
}

}  // namespace exemplar
