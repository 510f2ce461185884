#include "apps/exemplar/label/peer_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/labeling/evaluation/evaluation.h"
#include "host/mesh/mesh.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The folder of the peer's labels of a mesh; empty if it has none. Several categories may use the same mesh names.
fs::path folder_of_peer(const fs::path& folder, const std::string& category, const fs::path& mesh,
                        bool is_only_category) {
    if (fs::exists(labels_path(mesh, folder / category))) return folder / category;
    return is_only_category && fs::exists(labels_path(mesh, folder)) ? folder : fs::path();
}

bool have_one_category(std::span<const EvaluationTask> tasks) {
    return std::ranges::all_of(tasks, [&](const auto& task) { return task.category == tasks.front().category; });
}

/// Rates the peer's labels of the faces that ours are rated on.
Json rate_peer(const EvaluationTask& task, const fs::path& mesh, const fs::path& labels,
               const std::vector<std::string>& learned) {
    LabeledCorpus truth = load_corpus({mesh}, {}, task.labels);
    const LabeledCorpus peer = with_label_order(load_corpus({mesh}, {}, labels), truth.names);
    LabeledMesh& item = truth.meshes.front();
    const auto is_learned = [&](std::int32_t label) {
        return label < 0 || std::ranges::find(learned, truth.names[static_cast<std::size_t>(label)]) != learned.end();
    };
    for (std::int32_t& label : item.label)
        if (task.other_category && !is_learned(label)) label = -1;
    const MeshScore score =
        score_labeling(face_areas(item.mesh), item.label, peer.meshes.front().label, peer.names.size());
    return {{"recognition_rate", rate_json(score.recognition_rate)},
            {"segment_weighted_accuracy", rate_json(score.segment_weighted_accuracy)}};
}

/// The means of both over meshes that the peer labeled, and on how many of them each is ahead.
Json compare_rates(const Json& meshes) {
    Json peers = Json::array();
    std::size_t ahead = 0, behind = 0;
    for (const Json& mesh : meshes) {
        peers.push_back(mesh["peer"]);
        const double gain = rate_of(mesh, "recognition_rate") - rate_of(mesh["peer"], "recognition_rate");
        ahead += gain > 0 ? 1 : 0, behind += gain < 0 ? 1 : 0;
    }
    const Json own_means = mean_rates(meshes), peer_means = mean_rates(peers);
    Json result{{"meshes", meshes.size()}, {"ahead", ahead}, {"behind", behind}};
    for (const char* key : {"recognition_rate", "segment_weighted_accuracy"})
        result[key] = peer_means[key], result[std::string("own_") + key] = own_means[key];
    return result;
}

/// The sums of counts over categories, and the means of the rates that are known.
Json sum_categories(const Json& categories) {
    Json all = Json::object();
    for (const auto& [key, first] : categories.front().items()) {
        double sum = 0, count = 0;
        for (const Json& category : categories)
            if (const double value = rate_of(category, key.c_str()); !std::isnan(value)) sum += value, ++count;
        if (first.is_number_unsigned())
            all[key] = static_cast<std::size_t>(sum);
        else
            all[key] = rate_json(sum / count);  // null if no category has one
    }
    return all;
}

std::string in_percent(const Json& rates, const char* key) {
    const double rate = rate_of(rates, key);
    return std::isnan(rate) ? "-" : fmt::format("{:.1f}", 100 * rate);
}

void print_row(std::size_t width, const std::string& name, const Json& peer) {
    fmt::print("{:>{}} {:>6} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6}\n", name, width, peer["meshes"].get<std::size_t>(),
               in_percent(peer, "own_recognition_rate"), in_percent(peer, "recognition_rate"),
               in_percent(peer, "own_segment_weighted_accuracy"), in_percent(peer, "segment_weighted_accuracy"),
               peer["ahead"].get<std::size_t>(), peer["behind"].get<std::size_t>());
}

}  // namespace

void require_peer(std::span<const EvaluationTask> tasks, const fs::path& folder) {
    const bool one = have_one_category(tasks);
    for (const EvaluationTask& task : tasks)
        for (const fs::path& mesh : task.test)
            if (!folder_of_peer(folder, task.category, mesh, one).empty()) return;
    throw DataError(fmt::format("{}: holds labels of no test mesh (CATEGORY/NAME_labels.txt)", folder.string()));
}

void compare_with_peer(Json& report, std::span<const EvaluationTask> tasks, const fs::path& folder) {
    const bool one = have_one_category(tasks);
    Json categories = Json::array();
    for (Json& category : report["categories"]) {
        const std::string name = category["category"].get<std::string>();
        const auto task = std::ranges::find(tasks, name, &EvaluationTask::category);
        Json meshes = Json::array();
        for (Json& split : category["splits"])
            for (Json& mesh : split["meshes"]) {
                check_interrupt();
                const fs::path path = mesh["path"].get<std::string>();
                const fs::path labels = folder_of_peer(folder, name, path, one);
                if (labels.empty()) continue;
                mesh["peer"] = rate_peer(*task, path, labels, split["training"]["labels"]);
                meshes.push_back(mesh);
            }
        if (meshes.empty()) continue;
        category["peer"] = compare_rates(meshes);
        categories.push_back(category["peer"]);
    }
    if (!categories.empty()) report["peer"] = sum_categories(categories);
}

void print_peer(const Json& report) {
    std::size_t width = 12;
    for (const Json& category : report["categories"])
        width = std::max(width, category["category"].get<std::string>().size());
    fmt::print("\nBeside the other program's labels (in %; ahead, behind: meshes by recognition rate):\n");
    fmt::print("{:>{}} {:>6} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6}\n", "category", width, "meshes", "RR", "peer RR", "SW",
               "peer SW", "ahead", "behind");
    for (const Json& category : report["categories"])
        if (category.contains("peer")) print_row(width, category["category"], category["peer"]);
    if (report["categories"].size() > 1) print_row(width, "mean", report["peer"]);
}

}  // namespace exemplar
