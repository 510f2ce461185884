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

/// The folder of the peer's labels of a mesh; empty if it has none.
fs::path folder_of_peer(const fs::path& folder, const std::string& category, const fs::path& mesh) {
    for (const fs::path& candidate : {folder / category, folder})
        if (fs::exists(labels_path(mesh, candidate))) return candidate;
    return {};
}

/// The rates of the peer's labels, of those of our rates that need no segments.
Json rate_peer(const EvaluationTask& task, const fs::path& mesh, const fs::path& labels) {
    const LabeledCorpus truth = load_corpus({mesh}, {}, task.labels);
    const LabeledCorpus peer = with_label_order(load_corpus({mesh}, {}, labels), truth.names);
    const LabeledMesh& item = truth.meshes.front();
    const MeshScore score =
        score_labeling(face_areas(item.mesh), item.label, peer.meshes.front().label, peer.names.size());
    return {{"recognition_rate", rate_json(score.recognition_rate)},
            {"segment_weighted_accuracy", rate_json(score.segment_weighted_accuracy)}};
}

/// The means of both over the meshes that both labeled, and on how many of them each is ahead.
Json compare_rates(const Json& meshes) {
    Json ours = Json::array(), peers = Json::array();
    std::size_t ahead = 0, behind = 0;
    for (const Json& mesh : meshes) {
        if (!mesh.contains("peer")) continue;
        ours.push_back(mesh), peers.push_back(mesh["peer"]);
        const double gain = rate_of(mesh, "recognition_rate") - rate_of(mesh["peer"], "recognition_rate");
        ahead += gain > 0 ? 1 : 0, behind += gain < 0 ? 1 : 0;
    }
    const Json own_means = mean_rates(ours), peer_means = mean_rates(peers);
    Json result{{"meshes", ours.size()}, {"ahead", ahead}, {"behind", behind}};
    for (const char* key : {"recognition_rate", "segment_weighted_accuracy"})
        result[key] = peer_means[key], result[std::string("own_") + key] = own_means[key];
    return result;
}

void print_row(const std::string& name, const Json& peer) {
    fmt::print("{:>12} {:>6} {:>7.1f} {:>7.1f} {:>7.1f} {:>7.1f} {:>6} {:>6}\n", name,
               peer["meshes"].get<std::size_t>(), 100 * rate_of(peer, "own_recognition_rate"),
               100 * rate_of(peer, "recognition_rate"), 100 * rate_of(peer, "own_segment_weighted_accuracy"),
               100 * rate_of(peer, "segment_weighted_accuracy"), peer["ahead"].get<std::size_t>(),
               peer["behind"].get<std::size_t>());
}

}  // namespace

void compare_with_peer(Json& report, std::span<const EvaluationTask> tasks, const fs::path& folder) {
    Json categories = Json::array();
    for (Json& category : report["categories"]) {
        Json meshes = Json::array();
        for (Json& split : category["splits"])
            for (Json& mesh : split["meshes"]) {
                check_interrupt();
                const fs::path path = mesh["path"].get<std::string>();
                const std::string name = category["category"].get<std::string>();
                const fs::path labels = folder_of_peer(folder, name, path);
                if (labels.empty()) continue;
                const auto task = std::ranges::find(tasks, name, &EvaluationTask::category);
                mesh["peer"] = rate_peer(*task, path, labels);
                meshes.push_back(mesh);
            }
        if (meshes.empty()) continue;
        category["peer"] = compare_rates(meshes);
        categories.push_back(category["peer"]);
    }
    if (categories.empty())
        throw DataError(fmt::format("{}: holds labels of no test mesh (CATEGORY/NAME_labels.txt or NAME_labels.txt)",
                                    folder.string()));
    Json all{{"meshes", 0U}, {"ahead", 0U}, {"behind", 0U}};
    for (const auto& [key, value] : categories.front().items()) {
        double sum = 0;
        for (const Json& category : categories) sum += category[key].is_number() ? category[key].get<double>() : NAN;
        if (all.contains(key))
            all[key] = static_cast<std::size_t>(sum);
        else
            all[key] = rate_json(sum / static_cast<double>(categories.size()));
    }
    report["peer"] = all;
}

void print_peer(const Json& report) {
    fmt::print("\nBeside the other program's labels (in %; ahead, behind: meshes by recognition rate):\n");
    fmt::print("{:>12} {:>6} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6}\n", "category", "meshes", "RR", "peer RR", "SW",
               "peer SW", "ahead", "behind");
    for (const Json& category : report["categories"])
        if (category.contains("peer")) print_row(category["category"], category["peer"]);
    if (report["categories"].size() > 1) print_row("mean", report["peer"]);
}

}  // namespace exemplar
