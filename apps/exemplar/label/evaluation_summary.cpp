#include "apps/exemplar/label/evaluation_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "apps/exemplar/label/training_run.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

constexpr std::size_t k_listed_pairs = 10;  ///< of confused labels in the report
constexpr double k_printed_area = 0.0005;   ///< share of the surface below which a confusion is not printed
constexpr Rate k_rates[] = {
    {"recognition_rate", "recognition rate", "RR", false, true},
    {"segment_weighted_accuracy", "segment-weighted accuracy", "SW", false, true},
    {"without_cut", "recognition rate without the cut", "no cut", false, true},
    {"rand_error", "Rand index error", "RI err", true, true},
    {"cut_discrepancy", "cut discrepancy", "CD", true, false},
    {"hamming_distance", "Hamming distance", "HD", true, true},
    {"missing_rate", "missing rate", "miss", true, true},
    {"false_alarm_rate", "false alarm rate", "false", true, true},
    {"global_consistency_error", "global consistency error", "GCE", true, true},
    {"local_consistency_error", "local consistency error", "LCE", true, true},
};

/// Positions of names, in order of first use.
class NameList {
  public:
    std::size_t position(const std::string& name) {
        const auto [entry, added] = position_.try_emplace(name, names_.size());
        if (added) names_.push_back(name);
        return entry->second;
    }
    const std::vector<std::string>& names() const { return names_; }

  private:
    std::map<std::string, std::size_t> position_;
    std::vector<std::string> names_;
};

/// The off-diagonal entries of a confusion matrix that hold most area.
Json confused_pairs(const std::vector<std::string>& names, const std::vector<double>& confusion) {
    struct Pair {
        std::size_t truth, predicted;
        double area;
    };
    const std::size_t count = names.size();
    std::vector<Pair> pairs;
    std::vector<double> of_truth(count);
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t p = 0; p < count; ++p) {
            of_truth[t] += confusion[t * count + p];
            if (t != p && confusion[t * count + p] > 0) pairs.push_back({t, p, confusion[t * count + p]});
        }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.area > b.area; });
    Json result = Json::array();
    for (const Pair& pair : pairs) {
        if (result.size() == k_listed_pairs) break;
        result.push_back({{"truth", names[pair.truth]},
                          {"predicted", names[pair.predicted]},
                          {"area_share", pair.area},
                          {"label_share", pair.area / of_truth[pair.truth]}});
    }
    return result;
}

std::string shown_rate(const Rate& rate, double value) {
    if (std::isnan(value)) return "-";
    return rate.share ? fmt::format("{:.1f}", 100 * value) : fmt::format("{:.3f}", value);
}

/// Width of the column that names categories.
std::size_t name_width(const Json& categories) {
    std::size_t width = 12;
    for (const Json& category : categories) width = std::max(width, category["category"].get<std::string>().size());
    return width;
}

void print_rates(std::size_t width, const std::string& name, const std::string& meshes, const Json& rates) {
    fmt::print("{:>{}} {:>6}", name, width, meshes);
    for (const Rate& rate : k_rates) fmt::print(" {:>6}", shown_rate(rate, rate_of(rates, rate.key)));
    if (rates.contains("thesis"))
        for (const Rate& rate : k_rates)
            if (rates["thesis"].contains(rate.key))
                fmt::print("  {} {}", rate.column, shown_rate(rate, rate_of(rates["thesis"], rate.key)));
    fmt::print("\n");
}

void print_rate_table(const Json& categories, const Json& report) {
    const bool thesis = std::any_of(categories.begin(), categories.end(),
                                    [](const Json& category) { return category.contains("thesis"); });
    const std::size_t width = name_width(categories);
    fmt::print("{:>{}} {:>6}", "category", width, "meshes");
    for (const Rate& rate : k_rates) fmt::print(" {:>6}", rate.column);
    fmt::print("{}\n", thesis ? "  thesis" : "");
    for (const Json& category : categories)
        print_rates(width, category["category"], std::to_string(category["meshes"].get<std::size_t>()), category);
    if (categories.size() > 1) print_rates(width, "mean", "", report);
    fmt::print(
        "In %, but CD. RR recognition rate, SW segment-weighted accuracy, no cut RR of the classifiers alone.\n"
        "Against human segmentations: RI err Rand index error, CD cut discrepancy, HD Hamming distance (mean of\n"
        "miss, missing rate, and false, false alarm rate), GCE and LCE global and local consistency error.\n");
}

void print_shared_labels(const Json& category) {
    for (const Json& split : category["splits"]) {
        if (!split.contains("shared_labels")) continue;
        const auto shared = split["shared_labels"].get<std::vector<std::string>>();
        if (shared.empty())
            fmt::print("{}: training and test meshes have no label name in common, so only segments are compared\n",
                       category["category"].get<std::string>());
        else
            fmt::print("{}: RR and SW are of the labels that training and test meshes both have: {}\n",
                       category["category"].get<std::string>(), fmt::join(shared, ", "));
    }
}

/// Prints the confused pairs of largest area of each category, without negligible ones.
void print_confused(const Json& categories) {
    const std::size_t most = categories.size() == 1 ? 5 : 2, width = name_width(categories);
    bool headed = false;
    for (const Json& category : categories)
        for (std::size_t i = 0; i < std::min(most, category["confused"].size()); ++i) {
            const Json& pair = category["confused"][i];
            if (pair["area_share"].get<double>() < k_printed_area) break;
            if (!headed)
                fmt::print("\n{:>{}} {:>20} {:>20} {:>9} {:>10}\n", "category", width, "label", "taken for",
                           "% of area", "% of label");
            headed = true;
            fmt::print("{:>{}} {:>20} {:>20} {:>9.1f} {:>10.1f}\n",
                       i == 0 ? category["category"].get<std::string>() : "", width, pair["truth"].get<std::string>(),
                       pair["predicted"].get<std::string>(), 100 * pair["area_share"].get<double>(),
                       100 * pair["label_share"].get<double>());
        }
}

/// Prints families, the most used in the whole cascade first, with their share of each classifier's stumps.
void print_chosen_features(const Json& stages) {
    std::map<std::string, double> stumps;
    fmt::print("\n{:>16}", "% of stumps");
    for (const Json& stage : stages) {
        fmt::print(" {:>9}", stage["stage"].get<std::string>());
        for (const auto& [family, share] : stage["share_per_family"].items())
            stumps[family] += share.get<double>() * stage["stumps"].get<double>();
    }
    fmt::print("\n");
    std::vector<std::pair<std::string, double>> families(stumps.begin(), stumps.end());
    std::stable_sort(families.begin(), families.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    for (const auto& [family, count] : families) {
        fmt::print("{:>16}", family);
        for (const Json& stage : stages) fmt::print(" {:>9.1f}", 100 * stage["share_per_family"].value(family, 0.0));
        fmt::print("\n");
    }
}

}  // namespace

std::span<const Rate> evaluation_rates() {
    return k_rates;
}

double rate_of(const Json& json, const char* key) {
    return json.contains(key) && json[key].is_number() ? json[key].get<double>()
                                                       : std::numeric_limits<double>::quiet_NaN();
}

Json rate_json(double rate) {
    return std::isnan(rate) ? Json(nullptr) : Json(rate);
}

Json describe_scores(const MeshScore& labels, const MeshScore& uncut, const SegmentationErrors& segments) {
    return {{"recognition_rate", rate_json(labels.recognition_rate)},
            {"segment_weighted_accuracy", rate_json(labels.segment_weighted_accuracy)},
            {"without_cut", rate_json(uncut.recognition_rate)},
            {"rand_error", rate_json(segments.rand_index)},
            {"cut_discrepancy", rate_json(segments.cut_discrepancy)},
            {"hamming_distance", rate_json(segments.hamming_distance)},
            {"missing_rate", rate_json(segments.missing_rate)},
            {"false_alarm_rate", rate_json(segments.false_alarm_rate)},
            {"global_consistency_error", rate_json(segments.global_consistency)},
            {"local_consistency_error", rate_json(segments.local_consistency)}};
}

Json mean_rates(const Json& items) {
    Json means = Json::object();
    for (const Rate& rate : k_rates) {
        double sum = 0;
        int count = 0;
        for (const Json& item : items)
            if (const double value = rate_of(item, rate.key); !std::isnan(value)) sum += value, ++count;
        means[rate.key] = rate_json(count ? sum / count : std::numeric_limits<double>::quiet_NaN());
    }
    return means;
}

Json chosen_features(const LabelingModel& model) {
    Json stages = Json::array();
    for (std::size_t k = 0; k < model.unary.size(); ++k) {
        const std::size_t stumps = model.unary[k].stumps.stumps.size();
        Json shares = Json::object();
        for (const auto& [family, count] : stumps_per_family(model, k))
            shares[family] = static_cast<double>(count) / static_cast<double>(stumps);
        stages.push_back({{"stage", fmt::format("unary {}", k)}, {"stumps", stumps}, {"share_per_family", shares}});
    }
    return stages;
}

Json sum_chosen_features(const Json& models) {
    Json sum = Json::array();
    for (const Json& model : models)
        for (std::size_t k = 0; k < model.size(); ++k) {
            if (k == sum.size())
                sum.push_back({{"stage", model[k]["stage"]}, {"stumps", 0}, {"share_per_family", Json::object()}});
            Json& total = sum[k];
            const auto before = total["stumps"].get<std::size_t>(), added = model[k]["stumps"].get<std::size_t>();
            if (added == 0) continue;
            Json& shares = total["share_per_family"];
            for (const auto& [family, share] : model[k]["share_per_family"].items())
                if (!shares.contains(family)) shares[family] = 0.0;
            const double weight = static_cast<double>(added) / static_cast<double>(before + added);
            for (auto& [family, share] : shares.items())
                share = (1 - weight) * share.get<double>() + weight * model[k]["share_per_family"].value(family, 0.0);
            total["stumps"] = before + added;
        }
    return sum;
}

Json confusion_of(const Json& meshes) {
    NameList list;
    for (const Json& mesh : meshes)
        for (const std::string name : mesh["names"]) list.position(name);
    const std::size_t count = list.names().size();
    std::vector<double> sum(count * count);
    for (const Json& mesh : meshes) {
        std::vector<std::size_t> position;
        for (const std::string name : mesh["names"]) position.push_back(list.position(name));
        const auto confusion = mesh["confusion"].get<std::vector<double>>();
        for (std::size_t t = 0; t < position.size(); ++t)
            for (std::size_t p = 0; p < position.size(); ++p)
                sum[position[t] * count + position[p]] +=
                    confusion[t * position.size() + p] / static_cast<double>(meshes.size());
    }
    return {{"names", list.names()}, {"confusion", sum}, {"confused", confused_pairs(list.names(), sum)}};
}

void print_evaluation(const Json& report) {
    print_rate_table(report["categories"], report);
    for (const Json& category : report["categories"]) print_shared_labels(category);
    print_confused(report["categories"]);
    print_chosen_features(report["features"]);
}

}  // namespace exemplar
