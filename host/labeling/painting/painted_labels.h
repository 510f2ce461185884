#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/mesh/labels.h"

namespace exemplar {

constexpr std::int32_t k_unpainted = -1;

/// A label that can be painted.
struct PaletteEntry {
    std::string name;
    Color color{};
};

/// The labels that a person has painted on a mesh, with undo and redo without bound. A stroke that is still being
/// drawn is one step of undo; so is one fill. Memory grows with the number of changed faces.
class PaintedLabels {
  public:
    explicit PaintedLabels(std::size_t faces) : label_(faces, k_unpainted) {}

    /// Per face: an index into the palette, or k_unpainted.
    std::span<const std::int32_t> labels() const { return label_; }
    /// Number of painted faces.
    std::size_t painted_count() const { return painted_; }
    /// Changes with every change of labels.
    std::uint64_t version() const { return version_; }

    /// Replaces all labels; there is nothing to undo then. Throws UsageError for another number of faces.
    void start_with(std::span<const std::int32_t> labels);
    /// Begins a step of undo. What follows until the next call belongs to it.
    void begin_step();
    /// Gives these faces a label, or k_unpainted. Faces that have it already are left out. Without a step, begins one.
    void paint(std::span<const std::uint32_t> faces, std::int32_t label);
    /// Takes back the last step; returns false if there is none.
    bool undo();
    /// Repeats the step that was taken back last; returns false if there is none, or something was painted since.
    bool redo();
    bool can_undo() const { return done_ > 0; }
    bool can_redo() const { return done_ < steps_.size(); }

  private:
    struct Change {
        std::uint32_t face;
        std::int32_t before, after;
    };
    void set(std::uint32_t face, std::int32_t label);

    std::vector<std::int32_t> label_;
    std::size_t painted_ = 0;
    std::vector<std::vector<Change>> steps_;  ///< those before done_ can be taken back, the others repeated
    std::size_t done_ = 0;
    std::uint64_t version_ = 0;
};

}  // namespace exemplar
