#include "host/lines/extraction/face_types.h"

#include <fmt/format.h>

#include "host/core/errors.h"

namespace exemplar {

void add_face_types(const LineSurface& surface, std::span<const LineType> types, const LineOptions& options,
                    FaceTypes& faces) {
    for (const LineType type : types) {
        const std::vector<std::uint8_t> marks = classify_faces(surface, type, options);
        for (std::size_t f = 0; f < marks.size(); ++f)
            if (marks[f]) faces[f] |= bit_of(type);
    }
}

LineDifference::LineDifference(std::span<const LineType> types) {
    for (const LineType type : types) types_ |= bit_of(type);
}

void LineDifference::add(std::span<const std::uint16_t> truth, std::span<const std::uint16_t> guess) {
    if (truth.size() != guess.size())
        throw UsageError(
            fmt::format("lines of {} faces beside those of {}; compare the same surface", guess.size(), truth.size()));
    faces_ += truth.size();
    for (std::size_t f = 0; f < truth.size(); ++f) {
        const unsigned carried = truth[f] & types_, wrong = (truth[f] ^ guess[f]) & types_;
        if (!carried && !wrong) continue;
        for (std::size_t i = 0; i < k_any; ++i) {
            counts_[i].truth += carried >> i & 1u;
            counts_[i].misclassified += wrong >> i & 1u;
        }
        counts_[k_any].truth += carried != 0;
        counts_[k_any].misclassified += wrong != 0;
    }
}

void LineDifference::add(const LineDifference& other) {
    faces_ += other.faces_;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        counts_[i].truth += other.counts_[i].truth;
        counts_[i].misclassified += other.counts_[i].misclassified;
    }
}

LineDifference::Shares LineDifference::shares(std::size_t of) const {
    if (faces_ == 0) return {};
    const auto share = [&](std::size_t count) { return static_cast<double>(count) / static_cast<double>(faces_); };
    return {share(counts_[of].truth), share(counts_[of].misclassified)};
}

}  // namespace exemplar
