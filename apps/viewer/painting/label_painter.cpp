#include "apps/viewer/painting/label_painter.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "host/data/corpus.h"
#include "host/mesh/queries/axes.h"
#include "host/mesh/queries/point_tree.h"

namespace exemplar {
namespace {

constexpr float k_uncertain = 0.7F;            ///< confidence below which a face is looked at
constexpr float k_max_symmetry_error = 0.01F;  ///< of the bounding box' diagonal
constexpr float k_mirror_reach = 0.02F;        ///< likewise: how far a mirror image may lie from a face

Color mixed(const Color& a, const Color& b, float share_of_b) {
    Color result{};
    for (std::size_t c = 0; c < 3; ++c)
        result[c] = static_cast<std::uint8_t>(
            std::lround((1 - share_of_b) * static_cast<float>(a[c]) + share_of_b * static_cast<float>(b[c])));
    return result;
}

}  // namespace

LabelPainter::LabelPainter(const TriangleMesh& file_mesh, TriangleMesh shown, std::filesystem::path cache)
    : file_(file_mesh),
      shown_(std::move(shown)),
      topology_(build_topology(shown_)),
      painted_(file_.source_face_count > 0 ? file_.source_face_count : file_.face_count()),
      label_(painted_.labels().size(), k_unpainted),
      confidence_(label_.size(), 0),
      visited_(shown_.face_count(), false),
      worker_(file_, std::move(cache)) {}

void LabelPainter::start_with(std::span<const std::int32_t> labels) {
    painted_.start_with(labels);
    show_painted();
}

void LabelPainter::set_label_count(std::size_t count) {
    label_count_ = count;
}

void LabelPainter::show_suggestion(const CompletedLabels& triangles) {
    suggested_ = to_source_faces(file_, triangles.label);
    suggested_confidence_.assign(suggested_.size(), 0);
    for (std::uint32_t t = 0; t < triangles.confidence.size(); ++t)
        suggested_confidence_[file_.source_of(t)] = triangles.confidence[t];
    visited_.assign(shown_.face_count(), false);
    show_painted();
    asked_labels_ = 0;  // asks anew if something is painted
}

void LabelPainter::paint_shown(std::span<const std::uint32_t> shown_faces, std::int32_t label) {
    std::vector<std::uint32_t> faces;
    faces.reserve(shown_faces.size());
    for (const std::uint32_t face : shown_faces) faces.push_back(shown_.source_of(face));
    painted_.paint(faces, label);
    if (label == k_unpainted) return;
    for (const std::uint32_t face : faces) label_[face] = label, confidence_[face] = 1;
    ++version_;
}

void LabelPainter::brush(const FacePicture& picture, const PaintSettings& settings, const Vec2& from, const Vec2& to) {
    const std::vector<std::uint32_t> faces = settings.through
                                                 ? brushed_faces_through(shown_, picture, from, to, settings.radius)
                                                 : brushed_faces(picture, from, to, settings.radius);
    paint_shown(faces, settings.tool == PaintTool::eraser ? k_unpainted : settings.label);
}

void LabelPainter::lasso(const FacePicture& picture, const PaintSettings& settings, std::span<const Vec2> polygon) {
    painted_.begin_step();
    paint_shown(settings.through ? faces_in_lasso_through(shown_, picture, polygon) : faces_in_lasso(picture, polygon),
                settings.label);
}

void LabelPainter::fill(std::uint32_t shown_face, std::int32_t label) {
    const std::int32_t replaced = label_[shown_.source_of(shown_face)];
    std::vector<bool> seen(shown_.face_count(), false);
    std::vector<std::uint32_t> piece{shown_face};
    seen[shown_face] = true;
    for (std::size_t i = 0; i < piece.size(); ++i)
        for (const std::uint32_t e : topology_.edges_of_face(piece[i]))
            for (const std::uint32_t other : topology_.edges[e].face) {
                if (other == k_invalid_index || seen[other] || label_[shown_.source_of(other)] != replaced) continue;
                seen[other] = true;
                piece.push_back(other);
            }
    painted_.begin_step();
    paint_shown(piece, label);
}

std::size_t LabelPainter::mirror() {
    const std::vector<SymmetryPlane> planes = symmetry_planes(shown_, 1);
    if (planes.empty() || planes.front().error > k_max_symmetry_error) return 0;
    const std::vector<Vec3> center = face_centers(shown_);
    const std::vector<std::int32_t> before(painted_.labels().begin(), painted_.labels().end());
    const PointTree tree(center);
    const auto reach = k_mirror_reach * static_cast<float>(bounding_box(shown_).diagonal());
    painted_.begin_step();
    std::size_t count = 0;
    for (std::uint32_t f = 0; f < center.size(); ++f) {
        if (before[shown_.source_of(f)] >= 0) continue;
        const Vec3 image =
            center[f] - 2 * (center[f] - planes.front().point).dot(planes.front().normal) * planes.front().normal;
        const std::uint32_t twin = tree.nearest(image);
        const std::int32_t label = before[shown_.source_of(twin)];
        if (label < 0 || (center[twin] - image).norm() > reach) continue;
        paint_shown(std::span(&f, 1), label);
        ++count;
    }
    return count;
}

void LabelPainter::keep_shown() {
    painted_.begin_step();
    for (std::uint32_t face = 0; face < label_.size(); ++face)
        if (label_[face] >= 0) painted_.paint(std::span(&face, 1), label_[face]);
}

bool LabelPainter::undo() {
    if (!painted_.undo()) return false;
    show_painted();
    return true;
}

bool LabelPainter::redo() {
    if (!painted_.redo()) return false;
    show_painted();
    return true;
}

bool LabelPainter::discard_suggestion() {
    if (suggested_.empty()) return false;
    suggested_.clear();
    suggested_confidence_.clear();
    worker_.discard_suggestion();
    show_painted();
    return true;
}

// Shows what is painted over what is suggested; a completion then replaces it.
void LabelPainter::show_painted() {
    for (std::size_t face = 0; face < label_.size(); ++face) {
        const std::int32_t painted = painted_.labels()[face];
        label_[face] = painted >= 0 ? painted : suggested_.empty() ? k_unpainted : suggested_[face];
        confidence_[face] = painted >= 0 ? 1 : suggested_.empty() ? 0 : suggested_confidence_[face];
    }
    ++version_;
}

std::vector<std::int32_t> LabelPainter::painted_triangles() const {
    std::vector<std::int32_t> painted;
    painted.reserve(file_.face_count());
    for (std::uint32_t t = 0; t < file_.face_count(); ++t) painted.push_back(painted_.labels()[file_.source_of(t)]);
    return painted;
}

// Asks for a completion if what is painted has changed.
void LabelPainter::ask(const PaintSettings& settings) {
    if (settings.completes != completes_) {
        completes_ = settings.completes;
        asked_labels_ = 0;
        if (!completes_) show_painted();
    }
    const bool changed = asked_version_ != painted_.version() || asked_labels_ != label_count_;
    asked_version_ = painted_.version();
    if (!completes_ || !changed) return;
    asked_labels_ = label_count_;
    if (painted_.painted_count() > 0)
        worker_.request(painted_triangles(), label_count_, painted_.version());
    else
        show_painted();
}

void LabelPainter::show_completion(const CompletionWorker::Answer& answer) {
    completion_seconds_ = answer.seconds;
    label_ = to_source_faces(file_, answer.labels.label);
    for (std::uint32_t t = 0; t < answer.labels.confidence.size(); ++t)
        confidence_[file_.source_of(t)] = answer.labels.confidence[t];
    for (std::size_t face = 0; face < label_.size(); ++face)
        if (painted_.labels()[face] >= 0) label_[face] = painted_.labels()[face], confidence_[face] = 1;
    ++version_;
}

bool LabelPainter::poll(const PaintSettings& settings) {
    const std::uint64_t before = version_;
    if (const auto suggestion = worker_.take_suggestion()) show_suggestion(*suggestion);
    ask(settings);
    const std::optional<CompletionWorker::Answer> answer = worker_.take();
    if (answer && completes_ && painted_.painted_count() > 0) show_completion(*answer);
    return version_ != before;
}

std::size_t LabelPainter::unlabeled_count() const {
    return static_cast<std::size_t>(std::ranges::count(label_, k_unpainted));
}

std::vector<Color> LabelPainter::face_colors(std::span<const PaletteEntry> palette,
                                             const PaintSettings& settings) const {
    constexpr Color k_paper{245, 244, 240}, k_clay{206, 204, 198};
    constexpr float k_completed = 0.35F;  // how pale what is not painted is
    std::vector<Color> colors;
    colors.reserve(shown_.face_count());
    for (std::uint32_t f = 0; f < shown_.face_count(); ++f) {
        const std::uint32_t face = shown_.source_of(f);
        const std::int32_t label = label_[face];
        Color color = label >= 0 && static_cast<std::size_t>(label) < palette.size()
                          ? palette[static_cast<std::size_t>(label)].color
                          : k_clay;
        if (label >= 0 && settings.confidence)
            color = mixed(k_clay, color, std::clamp(2 * confidence_[face] - 1, 0.0F, 1.0F));
        const bool painted = painted_.labels()[face] >= 0;
        colors.push_back(label >= 0 && !painted ? mixed(color, k_paper, k_completed) : color);
    }
    return colors;
}

std::optional<SurfacePlace> LabelPainter::next_uncertain_place() {
    const std::vector<float> area = face_areas(shown_);
    const auto uncertain = [&](std::uint32_t f) {
        return !visited_[f] && confidence_[shown_.source_of(f)] < k_uncertain;
    };
    std::vector<std::uint32_t> best;
    float most = 0;
    std::vector<bool> seen(shown_.face_count(), false);
    for (std::uint32_t start = 0; start < shown_.face_count(); ++start) {
        if (seen[start] || !uncertain(start)) continue;
        std::vector<std::uint32_t> piece{start};
        seen[start] = true;
        float weight = 0;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            weight += area[piece[i]] * (1 - confidence_[shown_.source_of(piece[i])]);
            for (const std::uint32_t e : topology_.edges_of_face(piece[i]))
                for (const std::uint32_t other : topology_.edges[e].face) {
                    if (other == k_invalid_index || seen[other] || !uncertain(other)) continue;
                    seen[other] = true;
                    piece.push_back(other);
                }
        }
        if (weight > most) most = weight, best = std::move(piece);
    }
    if (best.empty()) return std::nullopt;
    const std::vector<Vec3> center = face_centers(shown_), normal = face_normals(shown_);
    Vec3d point = Vec3d::Zero(), toward = Vec3d::Zero();
    double total = 0;
    for (const std::uint32_t f : best) {
        const double weight = static_cast<double>(area[f]) + 1e-30;
        point += weight * center[f].cast<double>();
        toward += weight * normal[f].cast<double>();
        total += weight;
        visited_[f] = true;
    }
    return SurfacePlace{(point / total).cast<float>(), unit_or_up(toward)};
}

}  // namespace exemplar
