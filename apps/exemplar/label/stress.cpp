// exemplar label stress: damages meshes on purpose and reports how much of their labels a model keeps.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/labeled_output.h"
#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/data/corpus.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/mesh/editing/validate.h"
#include "host/synth/damage/damage.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct StressOptions {
    CommonOptions common;
    fs::path model, out;
    fs::path cache = default_feature_folder();
    std::vector<fs::path> meshes;
    std::vector<std::string> damages;
    std::uint64_t seed = 1;
};

/// A mesh as its file holds it.
struct Subject {
    fs::path path;
    TriangleMesh mesh;
    std::vector<std::int32_t> truth;  ///< per triangle, as the model numbers its labels; empty if the file has none
};

/// Result of one mesh under one damage. Rates are shares of the area, in [0, 1].
struct Outcome {
    std::size_t faces = 0;
    double unchanged = 1;                    ///< of the damaged surface, labeled as its original
    std::optional<double> recognition_rate;  ///< where the mesh has labels
    double seconds = 0;
    std::vector<std::string> warnings{};
    std::string error{};  ///< why it could not be labeled; nothing is unchanged then
};

struct StressRow {
    std::string name, what;
    std::vector<Outcome> outcomes;  ///< one per mesh
};

/// Returns true labels as numbers of the model; labels unknown to it get numbers that it never predicts.
std::vector<std::int32_t> true_labels(const fs::path& path, const MeshFile& file, const LabelingModel& model) {
    if (!file.labels && !fs::exists(labels_path(path))) return {};
    const LabeledCorpus own = load_corpus({path});
    std::vector<std::int32_t> truth = own.meshes.front().label;
    const auto& names = model.label_names;
    for (std::int32_t& label : truth)
        if (label >= 0)
            label = static_cast<std::int32_t>(std::ranges::find(names, own.names[static_cast<std::size_t>(label)]) -
                                              names.begin());
    return truth;
}

/// Reads and checks all meshes: a bad one should not cost the minutes of those before it.
std::vector<Subject> read_subjects(const StressOptions& options, const LabelingModel& model) {
    const std::vector<fs::path> paths = meshes_of_arguments(options.meshes);
    if (!options.out.empty()) require_distinct_names(paths);
    std::vector<Subject> subjects;
    for (const fs::path& path : paths) {
        check_interrupt();
        MeshFile file = read_mesh(path);
        require_usable(file.mesh, path.string());
        std::vector<std::int32_t> truth = true_labels(path, file, model);
        subjects.push_back({path, std::move(file.mesh), std::move(truth)});
    }
    return subjects;
}

/// Returns the share of the area with label[f] == expected[origin[f]] among faces with an expected label; none
/// without.
std::optional<double> area_share_right(const DamagedMesh& damaged, const std::vector<std::int32_t>& label,
                                       const std::vector<std::int32_t>& expected) {
    const std::vector<float> area = face_areas(damaged.mesh);
    double right = 0, total = 0;
    for (std::size_t f = 0; f < area.size(); ++f) {
        const std::int32_t wanted = expected[damaged.origin[f]];
        if (wanted < 0) continue;
        total += static_cast<double>(area[f]);
        if (label[f] == wanted) right += static_cast<double>(area[f]);
    }
    return total > 0 ? std::optional(right / total) : std::nullopt;
}

class StressRun {
  public:
    explicit StressRun(const StressOptions& options)
        : options_(options),
          model_(model_of_argument(options.model)),
          subjects_(read_subjects(options, model_)),
          cache_(usable_cache(options.cache, options.common.quiet)),
          backend_(options.common.device) {
        rows_.push_back({"undamaged", "as the file has it", {}});
        for (const Damage* damage : chosen())
            rows_.push_back({std::string(damage->name), std::string(damage->what), {}});
    }

    void run() {
        Progress progress("labeling damaged meshes", subjects_.size() * rows_.size());
        for (const Subject& subject : subjects_) {
            const std::vector<std::int32_t> labels = label_undamaged(subject);
            progress.advance(1, subject.path.filename().string());
            for (std::size_t row = 1; row < rows_.size(); ++row) {
                check_interrupt();
                label_damaged(subject, labels, rows_[row]);
                progress.advance(1, fmt::format("{} {}", subject.path.filename().string(), rows_[row].name));
            }
        }
        progress.finish();
    }

    void print_table() const {
        fmt::print("{:<17} {:>9} {:>7} {:>7} {:>9}  what is done\n", "damage", "unchanged", "worst", "right",
                   "seconds");
        for (const StressRow& row : rows_) {
            const auto rate = mean(row, [](const Outcome& o) { return o.recognition_rate; });
            fmt::print("{:<17} {:>7.1f} % {:>5.1f} % {:>7} {:>9.1f}  {}\n", row.name, 100 * mean_unchanged(row),
                       100 * worst(row).unchanged, rate ? fmt::format("{:.1f} %", 100 * *rate) : "-",
                       *mean(row, [](const Outcome& o) { return std::optional(o.seconds); }), row.what);
        }
        fmt::print(
            "unchanged: share of the area with the label of the undamaged mesh, mean and worst over {}\n"
            "right: share of the area with its true label, where the meshes have labels; seconds: per mesh\n",
            counted(subjects_.size(), "mesh", "meshes"));
        for (const StressRow& row : rows_)
            for (const Outcome& outcome : row.outcomes)
                if (!outcome.error.empty()) fmt::print(stderr, "error: {}\n", outcome.error);
    }

    nlohmann::json describe() const {
        nlohmann::json rows = nlohmann::json::array();
        for (const StressRow& row : rows_) rows.push_back(describe(row));
        return {{"model", options_.model.string()},
                {"device", backend_.device_name()},
                {"seed", options_.seed},
                {"damages", rows}};
    }

  private:
    std::vector<const Damage*> chosen() const {
        std::vector<const Damage*> result;
        for (const std::string& name : options_.damages) result.push_back(&damage_named(name));
        if (!result.empty()) return result;
        for (const Damage& damage : damages()) result.push_back(&damage);
        return result;
    }

    std::vector<std::int32_t> label_undamaged(const Subject& subject) {
        DamagedMesh same{subject.mesh, std::vector<std::uint32_t>(subject.mesh.face_count())};
        for (std::uint32_t f = 0; f < same.origin.size(); ++f) same.origin[f] = f;
        Outcome outcome;
        try {
            std::vector<std::int32_t> labels = label(subject, same, cache_, rows_.front().name, outcome);
            rows_.front().outcomes.push_back(std::move(outcome));
            return labels;
        } catch (const MeshError& error) {
            throw MeshError(fmt::format("{}: {}", subject.path.string(), error.what()));
        }
    }

    void label_damaged(const Subject& subject, const std::vector<std::int32_t>& undamaged, StressRow& row) {
        Outcome outcome;
        try {
            const DamagedMesh damaged = damage_named(row.name).apply(subject.mesh, options_.seed);
            const std::vector<std::int32_t> labels = label(subject, damaged, {}, row.name, outcome);
            outcome.unchanged = area_share_right(damaged, labels, undamaged).value_or(1);
        } catch (const MeshError& error) {
            outcome.unchanged = 0;
            if (!subject.truth.empty()) outcome.recognition_rate = 0;
            outcome.error = fmt::format("{} ({}): {}", subject.path.string(), row.name, error.what());
        }
        row.outcomes.push_back(std::move(outcome));
    }

    /// Labels each polygon and returns labels per triangle. `cache` is empty for damaged meshes, as no other run
    /// reads their features.
    std::vector<std::int32_t> label(const Subject& subject, const DamagedMesh& damaged, const fs::path& cache,
                                    const std::string& name, Outcome& outcome) {
        const Stopwatch watch;
        outcome.warnings = labeling_warnings(damaged.mesh, subject.path.string());
        const FaceLabeling labeling = label_mesh(model_, damaged.mesh, cache, backend_.labeling());
        outcome.seconds = watch.wall();
        outcome.faces = damaged.mesh.face_count();
        if (!options_.out.empty()) write_picture(subject, damaged.mesh, labeling, name);
        const std::vector<std::int32_t> polygon = to_source_faces(damaged.mesh, labeling.label);
        std::vector<std::int32_t> labels(damaged.mesh.face_count());
        for (std::uint32_t f = 0; f < labels.size(); ++f) labels[f] = polygon[damaged.mesh.source_of(f)];
        if (!subject.truth.empty()) outcome.recognition_rate = area_share_right(damaged, labels, subject.truth);
        return labels;
    }

    void write_picture(const Subject& subject, const TriangleMesh& mesh, const FaceLabeling& labeling,
                       const std::string& name) {
        const std::string stem = (options_.out / subject.path.stem()).string() + "-" + name;
        const LabeledOutput output = make_labeled_output(mesh, model_, labeling);
        write_ply(stem + ".ply", mesh, &output.labels, output.confidence);
        backend_.render_png(stem + ".png", mesh, triangle_colors(model_, labeling));
    }

    /// Returns the mean of a function over the outcomes for which it has a value.
    template <typename Function>
    static std::optional<double> mean(const StressRow& row, Function&& function) {
        double sum = 0, count = 0;
        for (const Outcome& outcome : row.outcomes)
            if (const std::optional<double> value = function(outcome)) sum += *value, count += 1;
        return count > 0 ? std::optional(sum / count) : std::nullopt;
    }
    static double mean_unchanged(const StressRow& row) {
        return *mean(row, [](const Outcome& o) { return std::optional(o.unchanged); });
    }
    static const Outcome& worst(const StressRow& row) {
        return *std::ranges::min_element(row.outcomes, {}, &Outcome::unchanged);
    }

    nlohmann::json describe(const StressRow& row) const {
        nlohmann::json meshes = nlohmann::json::array();
        for (std::size_t i = 0; i < row.outcomes.size(); ++i) {
            const Outcome &outcome = row.outcomes[i], &before = rows_.front().outcomes[i];
            nlohmann::json json{{"mesh", subjects_[i].path.string()},
                                {"faces", outcome.faces},
                                {"unchanged", outcome.unchanged},
                                {"seconds", outcome.seconds},
                                {"warnings", outcome.warnings}};
            if (!outcome.error.empty()) json["error"] = outcome.error;
            if (outcome.recognition_rate) json["recognition_rate"] = *outcome.recognition_rate;
            if (before.recognition_rate) json["recognition_rate_before"] = *before.recognition_rate;
            meshes.push_back(std::move(json));
        }
        nlohmann::json json{{"damage", row.name},
                            {"what", row.what},
                            {"unchanged_mean", mean_unchanged(row)},
                            {"unchanged_worst", worst(row).unchanged},
                            {"seconds", *mean(row, [](const Outcome& o) { return std::optional(o.seconds); })},
                            {"meshes", std::move(meshes)}};
        const auto rate = [](const Outcome& o) { return o.recognition_rate; };
        if (const auto after = mean(row, rate)) json["recognition_rate"] = *after;
        if (const auto before = mean(rows_.front(), rate)) json["recognition_rate_before"] = *before;
        return json;
    }

    const StressOptions& options_;
    LabelingModel model_;
    std::vector<Subject> subjects_;
    fs::path cache_;
    DeviceBackend backend_;
    std::vector<StressRow> rows_;  ///< the undamaged meshes first
};

void run_stress(const StressOptions& options) {
    const auto limits = apply_common_options(options.common);
    for (const std::string& name : options.damages) damage_named(name);
    if (!options.out.empty()) require_output_folder(options.out);
    StressRun run(options);
    run.run();
    run.print_table();
    write_report(options.common, run.describe());
}

std::vector<std::string> damage_names() {
    std::vector<std::string> names;
    for (const Damage& damage : damages()) names.emplace_back(damage.name);
    return names;
}

std::string list_of_damages() {
    std::string list = "Damages:\n";
    for (const Damage& damage : damages()) list += fmt::format("  {:<17} {}\n", damage.name, damage.what);
    return list;
}

}  // namespace

void add_stress_command(Command& label) {
    auto options = std::make_shared<StressOptions>();
    Command* command =
        label.add_subcommand("stress", "Damages meshes on purpose and reports how much of their labels a model keeps");
    command->footer(list_of_damages() +
                    "\nExample:\n"
                    "  exemplar label stress human.safetensors a.off b.obj --damage holes noise --json stress.json");
    command->add_option("MODEL", options->model, "model file of 'exemplar label train'")->required()->type_name("");
    command
        ->add_option("MESH", options->meshes,
                     "meshes, folders of meshes, or lists (.txt, a path a line); labels beside them are compared, too")
        ->required()
        ->type_name("");
    command->add_option("--damage", options->damages, "only these damages; all of them, if not given")
        ->check(completion_words(damage_names()))
        ->type_name("NAME");
    command->add_option("--seed", options->seed, "seed of what is damaged where")
        ->capture_default_str()
        ->check(whole_number(0));
    command
        ->add_option("--out", options->out,
                     "also write the labeled meshes, damaged and not, as MESH-DAMAGE.ply and .png")
        ->type_name("FOLDER");
    command
        ->add_option("--cache", options->cache, "folder that remembers features of undamaged meshes; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_stress(*options); });
}

}  // namespace exemplar
