#include "apps/exemplar/batch_work.h"

#include <fmt/format.h>

#include <array>
#include <system_error>
#include <vector>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/labeled_output.h"
#include "host/core/errors.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// So few that two programs that share a catalog end together, so many that asking costs nothing.
constexpr std::size_t k_claimed_at_once = 4;

constexpr std::array k_endings{"_labels.txt", ".seg", ".ply", ".glb"};

/// Moves a shape's files from a folder to another one of the same file system, in the place of all that it had there.
void move_files(const fs::path& from, const fs::path& to, const std::string& name) {
    for (const char* const ending : k_endings) {
        const fs::path source = from / (name + ending), target = to / (name + ending);
        std::error_code error;
        fs::rename(source, target, error);
        if (error == std::errc::no_such_file_or_directory) fs::remove(target, error);
        if (error) throw DataError(fmt::format("{}: cannot be written: {}", target.string(), error.message()));
    }
}

}  // namespace

void BatchCounts::count(const ShapeRecord& record, bool is_new) {
    if (!is_new) ++taken_over;
    const std::string state = record.state();
    ++(state == "done" ? done : state == "unknown" ? unknown : failed);
}

void reopen_shapes(CatalogRun& run, bool retry) {
    std::vector<std::int64_t> missing;
    std::error_code ignored;
    run.for_each(
        [&](const CatalogRun::Labeled& labeled) {
            const fs::path path = run.record_path(labeled.shape);
            if (retry && labeled.state != "done") fs::remove(path, ignored);
            if (!run.record_of(labeled.shape)) missing.push_back(labeled.shape.id);
        },
        "state <> 'claimed'");
    for (const std::int64_t shape : missing) run.reopen(shape);
}

CatalogWork::CatalogWork(Catalog& catalog, CatalogRun& run, const fs::path& output, const std::string& worker)
    : catalog_(catalog), run_(run), output_(output), worker_(worker) {
    free_claims_of_the_dead();
}

CatalogWork::~CatalogWork() {
    try {
        run_.release(worker_);
    } catch (const Error&) {
        // The next program sees that this one is dead.
    }
}

void CatalogWork::free_claims_of_the_dead() {
    for (const std::string& worker : run_.workers())
        if (!WorkerFolder::may_be_alive(output_, worker)) run_.release(worker);
}

bool CatalogWork::claim_some() {
    for (const CatalogShape& shape : run_.claim(worker_, k_claimed_at_once, last_)) {
        last_ = shape.id;
        claimed_.push_back(shape);
    }
    return !claimed_.empty();
}

std::optional<CatalogShape> CatalogWork::next() {
    const std::lock_guard lock(mutex_);
    for (;;) {
        if (claimed_.empty() && !claim_some()) {
            if (!again_) return {};
            again_ = false;  // once more from the beginning: another program may have died meanwhile
            last_ = 0;
            free_claims_of_the_dead();
            continue;
        }
        CatalogShape shape = std::move(claimed_.front());
        claimed_.pop_front();
        std::error_code ignored;
        const bool is_there = fs::exists(run_.record_path(shape), ignored);
        // A program that was killed after the record was written, and before the catalog was told.
        if (const auto record = run_.record_of(shape)) {
            run_.finish(shape.id, *record);
            counts_.count(*record, false);
            continue;
        }
        // One of another run, a damaged one, or of the file before it changed; not one that has come this moment.
        if (is_there) fs::remove(run_.record_path(shape), ignored);
        return shape;
    }
}

void CatalogWork::finish(const BatchShape& shape, bool is_new) {
    const std::lock_guard lock(mutex_);
    if (shape.changed) {
        const CatalogShape now = shape.shape;
        catalog_.put(std::span(&now, 1));
    }
    run_.finish(shape.shape.id, shape.record);
    counts_.count(shape.record, is_new);
}

std::size_t CatalogWork::total() {
    const std::lock_guard lock(mutex_);
    const CatalogRun::Counts counts = run_.counts();
    return static_cast<std::size_t>(counts.open + counts.claimed);
}

void BatchWriter::write_labels(BatchShape& shape, const fs::path& target) const {
    const LabeledOutput output = make_labeled_output(shape.mesh, shape.model->model, shape.labeling);
    write_labeled_files(target, shape.mesh, output, gltf_);
    const nlohmann::json described = describe_output(shape.mesh, shape.model->model, shape.labeling);
    shape.record.labels = described["labels"];
    shape.record.confidence = described["confidence"];
}

/// Whether another program has been faster.
bool BatchWriter::is_done(BatchShape& shape, const fs::path& path) const {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) return false;
    std::optional<ShapeRecord> other = read_record(path);
    if (!other || other->run != key_ || other->content != shape.record.content)
        throw DataError(
            fmt::format("{}: another run, with other models or options, writes to the same folder; give one of "
                        "them another --out",
                        path.string()));
    shape.record = std::move(*other);
    return true;
}

bool BatchWriter::write(BatchShape& shape) const {
    const Stopwatch watch;
    const fs::path folder = make_output_folder(folder_, shape.shape.name);
    const std::string name = fs::path(shape.shape.name).filename().string();
    const fs::path staging = worker_.path() / "shape", target = folder / (name + ".json");
    fs::remove_all(staging);
    if (shape.record.error.empty()) write_labels(shape, staging / name);
    if (is_done(shape, target)) return false;
    move_files(staging, folder, name);
    ShapeRecord& record = shape.record;
    record.run = key_;
    record.worker = worker_.id();
    record.finished = seconds_since_1970();
    record.seconds["write"] = watch.wall();
    const fs::path written = worker_.path() / "record.json";
    for (;;) {
        write_json(written, to_json(record));
        if (commit_file(written, target)) return true;
        if (is_done(shape, target)) return false;
    }
}

}  // namespace exemplar
