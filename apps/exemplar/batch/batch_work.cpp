#include "apps/exemplar/batch/batch_work.h"

#include <fmt/format.h>

#include <array>
#include <new>
#include <string_view>
#include <system_error>
#include <vector>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/labeled_output.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Few enough that two programs that share a catalog end together, many enough that claiming costs nothing.
constexpr std::size_t k_claimed_at_once = 4;

constexpr std::string_view k_optional_ending = ".glb";
constexpr std::array<std::string_view, 4> k_endings{"_labels.txt", ".seg", ".ply", k_optional_ending};

/// Removes a file of a shape's results.
void remove_file(const fs::path& file) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw DataError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
}

/// Moves a shape's files to another folder of the same file system, replacing all files that the shape had there.
void move_files(const fs::path& from, const fs::path& to, const std::string& name) {
    for (const std::string_view ending : k_endings) {
        const fs::path source = from / fmt::format("{}{}", name, ending), target = to / source.filename();
        std::error_code error;
        fs::rename(source, target, error);
        if (error == std::errc::no_such_file_or_directory && ending == k_optional_ending)
            remove_file(target);
        else if (error)
            throw DataError(fmt::format("{}: cannot be written: {}", target.string(), error.message()));
    }
}

void remove_files(const fs::path& folder, const std::string& name) {
    for (const std::string_view ending : k_endings) remove_file(folder / fmt::format("{}{}", name, ending));
}

/// Returns whether anything is at the path, even a dangling link.
bool is_taken(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

}  // namespace

void remove_record(const fs::path& folder, const std::string& name) {
    const fs::path file = fs::path(name).filename().string() + ".json";
    remove_file(make_output_folder(folder, name) / file);
}

void BatchCounts::count(const ShapeRecord& record, bool is_new) {
    if (!is_new) ++taken_over;
    const std::string state = record.state();
    ++(state == "done" ? done : state == "unknown" ? unknown : failed);
}

void reopen_shapes(CatalogRun& run, bool retry) {
    std::vector<std::int64_t> missing;
    run.for_each(
        [&](const CatalogRun::Labeled& labeled) {
            std::optional<ShapeRecord> record = run.record_of(labeled.shape);
            // Another program may have retried a shape since the catalog was asked for failed ones.
            if (retry && record && record->state() != "done") {
                remove_record(run.folder(), labeled.shape.name);
                record.reset();
            }
            if (!record) missing.push_back(labeled.shape.id);
        },
        "state <> 'claimed'");
    for (const std::int64_t shape : missing) run.reopen(shape);
}

CatalogWork::CatalogWork(Catalog& catalog, CatalogRun& run, const fs::path& output, const std::string& worker)
    : catalog_(catalog), run_(run), output_(output), worker_(worker) {
    release_dead_claims();
}

CatalogWork::~CatalogWork() {
    try {
        run_.release(worker_);
    } catch (const Error&) {
        // The next program frees the claims of this one.
    }
}

void CatalogWork::release_dead_claims() {
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
        check_interrupt();
        if (claimed_.empty() && !claim_some()) {
            if (!again_) return {};
            again_ = false;  // once more from the start, as another program may have died
            last_ = 0;
            release_dead_claims();
            continue;
        }
        CatalogShape shape = std::move(claimed_.front());
        claimed_.pop_front();
        const bool is_there = is_taken(run_.record_path(shape));
        // A program may have been killed between writing the record and updating the catalog.
        if (const auto record = run_.record_of(shape)) {
            run_.finish(shape.id, *record);
            counts_.count(*record, false);
            continue;
        }
        // Removes a record that is of another run, damaged, or of an older file; not one that appeared just now.
        if (is_there) remove_record(run_.folder(), shape.name);
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
    const LabeledOutput output = make_labeled_output(shape.file.mesh, shape.model->model, shape.labeling);
    write_labeled_files(target, shape.file, output, gltf_);
    const nlohmann::json described = describe_output(shape.file.mesh, shape.model->model, shape.labeling);
    shape.record.labels = described["labels"];
    shape.record.confidence = described["confidence"];
}

/// Writes labels. Records an error if a format cannot hold the shape or memory runs out; throws others, as a full
/// disk.
void BatchWriter::try_to_write_labels(BatchShape& shape, const fs::path& target) const {
    try {
        write_labels(shape, target);
    } catch (const MeshError& error) {
        shape.record.error = error.what();
    } catch (const std::bad_alloc&) {
        shape.record.error = shape.shape.path.string() + ": there is not enough memory to write its labels";
    }
}

/// Returns whether another program has written the shape; takes over its record.
bool BatchWriter::is_done(BatchShape& shape, const fs::path& path) const {
    if (!is_taken(path)) return false;
    std::optional<ShapeRecord> other = read_record(path);
    // A record of the same run may be of an older or newer state of the file; the next program that asks checks
    // that.
    if (!other || other->run != key_)
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
    ShapeRecord& record = shape.record;
    if (record.error.empty()) try_to_write_labels(shape, staging / name);
    if (is_done(shape, target)) return false;
    const bool failed = !record.error.empty();
    if (!failed) move_files(staging, folder, name);
    record.run = key_;
    record.worker = worker_.id();
    record.finished = seconds_since_1970();
    record.seconds["write"] = watch.wall();
    const fs::path written = worker_.path() / "record.json";
    for (;;) {
        check_interrupt();
        write_json(written, to_json(record));
        if (commit_file(written, target)) break;
        if (is_done(shape, target)) return false;
    }
    // Only now, as another program may have labeled the same shape meanwhile, with success.
    if (failed) remove_files(folder, name);
    return true;
}

}  // namespace exemplar
