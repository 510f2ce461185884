#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"

namespace exemplar {

/// The types of lines that each face carries: bit_of() each.
using FaceTypes = std::vector<std::uint16_t>;
constexpr std::uint16_t bit_of(LineType type) {
    return static_cast<std::uint16_t>(1u << static_cast<unsigned>(type));
}

/// Adds what classify_faces finds of these types; `faces` has an entry per face. Throws as that does.
void add_face_types(const LineSurface& surface, std::span<const LineType> types, const LineOptions& options,
                    FaceTypes& faces);

/// Misclassified faces: those that carry a line by one curvature but not by the other. Summed up over pictures of any
/// surfaces, views and frames.
class LineDifference {
  public:
    /// Other types than these do not count.
    explicit LineDifference(std::span<const LineType> types);

    /// Throws UsageError unless both are of as many faces.
    void add(std::span<const std::uint16_t> truth, std::span<const std::uint16_t> guess);
    void add(const LineDifference& other);

    /// As shares of all faces; zeros without any.
    struct Shares {
        double truth = 0;  ///< carry a line
        double misclassified = 0;
    };
    Shares of(LineType type) const { return shares(static_cast<std::size_t>(type)); }
    /// Of faces with a line of any type, and of those that differ in any.
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
