#include "apps/exemplar/category/category_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/text.h"
#include "host/data/result_cache.h"
#include "host/labeling/category/category_evaluation.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

CategoryTrials random_trials(const CategoryTrialOptions& options, std::uint64_t seed) {
    CategoryTrials trials{categories_of_arguments(options.sources), std::vector<Split>(options.splits), {}};
    std::size_t first = 0;
    for (std::size_t c = 0; c < trials.categories.size(); ++c) {
        const CategoryMeshes& category = trials.categories[c];
        if (category.meshes.size() <= options.train_count)
            throw UsageError(fmt::format("{} has {}; to learn from {} and test others takes more (see --train-count)",
                                         category.name, counted(category.meshes.size(), "mesh", "meshes"),
                                         options.train_count));
        const auto parts = make_splits(category.meshes.size(), options.train_count, options.splits, seed + c);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            for (const std::size_t i : parts[k].train) trials.splits[k].train.push_back(first + i);
            for (const std::size_t i : parts[k].test) trials.splits[k].test.push_back(first + i);
        }
        first += category.meshes.size();
    }
    return trials;
}

/// The one trial of --train and --test. Training meshes come first in each category.
CategoryTrials given_trial(const CategoryTrialOptions& options) {
    CategoryTrials trials{categories_of_arguments(options.train), {{}}, {}};
    std::vector<CategoryMeshes> tested = categories_of_arguments(options.test);
    Split& split = trials.splits.front();
    std::size_t next = 0;
    for (CategoryMeshes& category : trials.categories) {
        for (std::size_t i = 0; i < category.meshes.size(); ++i) split.train.push_back(next++);
        const auto more = std::ranges::find(tested, category.name, &CategoryMeshes::name);
        if (more == tested.end()) continue;
        for (std::size_t i = 0; i < more->meshes.size(); ++i) split.test.push_back(next++);
        category.meshes.insert(category.meshes.end(), more->meshes.begin(), more->meshes.end());
        tested.erase(more);
    }
    if (!tested.empty())
        throw UsageError(fmt::format("category {} is tested, but --train has none of it", tested.front().name));
    return trials;
}

/// Refuses what cannot be learned, and says which categories cannot be left out.
void check_trainings(CategoryTrials& trials) {
    std::vector<std::string> names;
    std::vector<std::int32_t> category;
    for (const CategoryMeshes& meshes : trials.categories) {
        category.insert(category.end(), meshes.meshes.size(), static_cast<std::int32_t>(names.size()));
        names.push_back(meshes.name);
    }
    std::string needed;
    for (std::size_t k = 0; k < trials.splits.size(); ++k)  // all have as many training meshes of each category
        for (const std::int32_t c : indispensable_categories(names, category, trials.splits[k]))
            if (k == 0) needed += (needed.empty() ? "" : ", ") + names[static_cast<std::size_t>(c)];
    if (needed.empty()) return;
    trials.remarks.push_back(
        fmt::format("not tested as shapes of a category that is not learned: {}; without one of these the rest could "
                    "not be learned, which takes two categories, and two meshes of one",
                    needed));
}

std::vector<std::string> content_hashes(const std::vector<fs::path>& paths) {
    Progress progress("reading meshes", paths.size());
    std::vector<std::string> hashes;
    for (const fs::path& path : paths) {
        check_interrupt();
        hashes.push_back(content_hash(read_mesh(path).mesh));
        progress.advance(1, path.filename().string());
    }
    progress.finish();
    return hashes;
}

/// A test mesh, and a training mesh of the same content.
struct DuplicatePair {
    std::size_t tested, trained;
};

std::vector<DuplicatePair> find_duplicates(const std::vector<std::string>& hashes, const Split& split) {
    std::map<std::string, std::size_t> trained;
    for (const std::size_t i : split.train) trained.emplace(hashes[i], i);
    std::vector<DuplicatePair> twins;
    for (const std::size_t i : split.test)
        if (const auto twin = trained.find(hashes[i]); twin != trained.end()) twins.push_back({i, twin->second});
    return twins;
}

/// Throws UsageError for a file that is given both to train on and to test.
void refuse_same_files(const CategoryTrials& trials) {
    const std::vector<fs::path> paths = trials.paths();
    std::set<fs::path> trained;
    for (const std::size_t i : trials.splits.front().train) trained.insert(fs::weakly_canonical(paths[i]));
    for (const std::size_t i : trials.splits.front().test)
        if (trained.contains(fs::weakly_canonical(paths[i])))
            throw UsageError(fmt::format("{}: is among the training meshes; test others", paths[i].string()));
}

void drop_duplicates(CategoryTrials& trials) {
    const std::vector<fs::path> paths = trials.paths();
    const std::vector<std::string> hashes = content_hashes(paths);
    struct SkipHandler {
        std::size_t splits = 0, trained = 0;
    };
    std::map<std::size_t, SkipHandler> left_out;
    std::size_t tests = 0;
    for (Split& split : trials.splits) {
        for (const DuplicatePair& twins : find_duplicates(hashes, split)) {
            std::erase(split.test, twins.tested);
            left_out[twins.tested] = {left_out[twins.tested].splits + 1, twins.trained};
        }
        tests += split.test.size();
    }
    for (const auto& [mesh, out] : left_out)
        trials.remarks.push_back(fmt::format("{}: not tested in {} of {}, where the same mesh is learned from: {}",
                                             paths[mesh].string(), out.splits, counted(trials.splits.size(), "split"),
                                             paths[out.trained].string()));
    if (tests == 0) throw UsageError("every test mesh is the same as a training mesh; nothing is left to test");
}

}  // namespace

std::vector<fs::path> CategoryTrials::paths() const {
    std::vector<fs::path> all;
    for (const CategoryMeshes& category : categories)
        all.insert(all.end(), category.meshes.begin(), category.meshes.end());
    return all;
}

CategoryTrials make_category_trials(const CategoryTrialOptions& options, std::uint64_t seed) {
    if (options.train.empty() != options.test.empty()) throw UsageError("--train and --test go together");
    if (options.sources.empty() == options.train.empty())
        throw UsageError(
            "give folders of meshes, each a category, to split, or --train SOURCE... and --test SOURCE...");
    const bool given = !options.train.empty();
    CategoryTrials trials = given ? given_trial(options) : random_trials(options, seed);
    if (given) refuse_same_files(trials);
    check_trainings(trials);
    drop_duplicates(trials);
    return trials;
}

}  // namespace exemplar
