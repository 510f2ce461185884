#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"

namespace exemplar {

/// The types of lines on each face, as a bit set of bit_of().
using FaceTypes = std::vector<std::uint16_t>;
constexpr std::uint16_t bit_of(LineType type) {
    return static_cast<std::uint16_t>(1u << static_cast<unsigned>(type));
}

/// Adds the bits of the types that classify_faces finds; `faces` has an entry per face. Throws the same errors.
void add_face_types(const LineSurface& surface, std::span<const LineType> types, const LineOptions& options,
                    FaceTypes& faces);

/// Counts misclassified faces, which have a line with one curvature but not with the other, over any number of
/// surfaces, views and frames.
class LineDifference {
  public:
    /// Other types than these are ignored.
    explicit LineDifference(std::span<const LineType> types);

    /// Adds one comparison. Throws UsageError if the numbers of faces differ.
    void add(std::span<const std::uint16_t> truth, std::span<const std::uint16_t> guess);
    void add(const LineDifference& other);

    /// Shares of all faces; zero if there are none.
    struct Shares {
        double truth = 0;  ///< faces with a line
        double misclassified = 0;
    };
    Shares of(LineType type) const { return shares(static_cast<std::size_t>(type)); }
    /// Counts faces with a line of any type, and faces that differ in any type.
    Shares of_any() const { return shares(k_any); }

  private:
    static constexpr std::size_t k_any = k_line_types.size();
    struct Count {
        std::size_t truth = 0, misclassified = 0;
    };
    Shares shares(std::size_t of) const;
    std::uint16_t types_ = 0;
    std::size_t faces_ = 0;
    std::array<Count, k_any + 1> counts_;
};

}  // namespace exemplar
