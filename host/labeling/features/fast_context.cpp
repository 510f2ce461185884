#include "host/labeling/features/fast_context.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "host/core/parallel.h"
#include "host/learn/boosting/lanes.h"

namespace exemplar {
namespace {

// Faces that are processed together: as many as there are geodesic ranges in a cache line. Their sums stay in the
// first-level cache.
constexpr std::size_t k_face_block = 64;
// Samples whose ranges are copied together: with the faces of a block they fit into the second-level cache.
constexpr std::size_t k_sample_block = 1024;
// Bins of a face, plus one for the samples that are in none of them.
constexpr std::size_t k_slots = k_context_bins + 1;
constexpr std::size_t k_edges = k_context_bins - 1;

// Classes are stored in panels of `width` lanes.
std::size_t panel_count(std::size_t classes, std::size_t width) {
    return (classes + width - 1) / width;
}

// Samples sorted along an axis. Those between two distances form two runs, whose masses are differences of prefix
// sums.
struct SortedAxis {
    // Rising, then padded with infinity to one less than a power of two, so that a search takes the same steps for all
    // faces.
    std::vector<float> position;
    AlignedFloats prefix;  // panels x (samples + 1) x width: the masses of the first samples
};

// Inputs of the histograms of one mesh.
struct Tables {
    const ContextMesh& mesh;
    std::size_t classes;
    std::size_t samples;
    AlignedFloats mass;  // panels x samples x width: a_j P(l | j)
    std::array<SortedAxis, k_context_axes> axes;
};

// Calls use(panel, lane, mass) for each class of a sample.
template <int width, typename Use>
void for_each_mass(const Tables& tables, std::size_t sample, Use&& use) {
    const ContextGeometry& geometry = *tables.mesh.geometry;
    const float* probability = tables.mesh.probabilities.data() + geometry.sample_face[sample] * tables.classes;
    const auto area = static_cast<double>(geometry.sample_area[sample]);
    for (std::size_t l = 0; l < tables.classes; ++l)
        use(l / width, l % width, area * static_cast<double>(probability[l]));
}

template <int width>
AlignedFloats fast_masses(const Tables& tables) {
    AlignedFloats mass(panel_count(tables.classes, width) * tables.samples * width);
    for (std::size_t j = 0; j < tables.samples; ++j)
        for_each_mass<width>(tables, j, [&](std::size_t panel, std::size_t lane, double value) {
            mass[(panel * tables.samples + j) * width + lane] = static_cast<float>(value);
        });
    return mass;
}

std::vector<std::uint32_t> rising_order(const std::vector<float>& position) {
    std::vector<std::uint32_t> order(position.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t sample) { return position[sample]; });
    return order;
}

template <int width>
SortedAxis sort_axis(const Tables& tables, std::size_t axis) {
    const ContextGeometry& geometry = *tables.mesh.geometry;
    const std::size_t samples = tables.samples, panels = panel_count(tables.classes, width);
    std::vector<float> position;
    for (const std::uint32_t face : geometry.sample_face)
        position.push_back(geometry.axis_position[axis * geometry.faces + face]);
    SortedAxis sorted;
    sorted.position.assign(std::bit_ceil(samples + 1) - 1, std::numeric_limits<float>::infinity());
    sorted.prefix.resize(panels * (samples + 1) * width);
    std::vector<double> sum(panels * width);  // in double precision, as all rounding errors would add up
    std::size_t next = 0;
    for (const std::uint32_t sample : rising_order(position)) {
        sorted.position[next++] = position[sample];
        for_each_mass<width>(tables, sample, [&](std::size_t panel, std::size_t lane, double value) {
            const double mass = sum[panel * width + lane] += value;
            sorted.prefix[(panel * (samples + 1) + next) * width + lane] = static_cast<float>(mass);
        });
    }
    return sorted;
}

// Adds the masses of samples to their bins, for the faces of a block; `ranges` is samples x faces, `sums` faces x
// slots. The sums of different faces are independent, so that the additions overlap.
template <int width>
void add_masses(const LaneFloats<width>* masses, std::size_t samples, const std::uint8_t* ranges,
                LaneFloats<width>* sums) {
    for (std::size_t j = 0; j < samples; ++j) {
        const LaneFloats<width> mass = masses[j];
        for (std::size_t f = 0; f < k_face_block; ++f) sums[f * k_slots + *ranges++] += mass;
    }
}

// A number of samples per face of a block.
using Counts = std::array<std::int32_t, k_face_block>;
using Positions = std::array<float, k_face_block>;

// Counts, for each face's position, the leading sorted samples that `pass`: a binary search without branches.
template <typename Pass>
void count_first(const SortedAxis& axis, std::size_t samples, const Positions& positions, Pass&& pass, Counts& counts) {
    const float* sorted = axis.position.data();
    counts.fill(0);
    for (auto step = static_cast<std::int32_t>((axis.position.size() + 1) / 2); step > 0; step /= 2)
        for (std::size_t f = 0; f < k_face_block; ++f) {
            const std::int32_t next = counts[f] + step;
            counts[f] = pass(positions[f], sorted[next - 1]) ? next : counts[f];
        }
    // For NaN positions all samples pass, and so does the padding.
    for (std::int32_t& count : counts) count = std::min(count, static_cast<std::int32_t>(samples));
}

// Samples [before[b], behind[b]) are nearer than edge b - 1. Bound 0 contains no sample, bound k_context_bins all.
struct Bounds {
    std::array<Counts, k_context_bins + 1> before, behind;
};

// The searches evaluate the same float expression |p - s| as the reference. It is monotonic on either side of p, so a
// sample on a bin's edge falls into the same bin.
void find_bounds(const Tables& tables, std::size_t axis, const Positions& positions, Bounds& bounds) {
    const SortedAxis& sorted = tables.axes[axis];
    const std::size_t samples = tables.samples;
    bounds.before[k_context_bins].fill(0);
    bounds.behind[k_context_bins].fill(static_cast<std::int32_t>(samples));
    for (std::size_t b = 1; b <= k_edges; ++b) {
        const float edge = tables.mesh.geometry->axis_edges[axis][b - 1];
        count_first(
            sorted, samples, positions, [&](float p, float s) { return p - s >= edge; }, bounds.before[b]);
        count_first(
            sorted, samples, positions, [&](float p, float s) { return !(s - p >= edge); }, bounds.behind[b]);
        for (std::size_t f = 0; f < k_face_block; ++f)  // nothing is nearer than an edge at 0
            bounds.behind[b][f] = std::max(bounds.behind[b][f], bounds.before[b][f]);
    }
    bounds.before[0] = bounds.behind[0] = bounds.before[1];
}

// The histograms of one block of faces.
template <int width>
class FaceBlock {
  public:
    explicit FaceBlock(const Tables& tables)
        : tables_(tables),
          ranges_(std::min(tables.samples, k_sample_block) * k_face_block),
          sums_(panel_count(tables.classes, width) * k_panel_sums * width) {}

    void accumulate(std::size_t first, std::size_t count) {
        first_ = first;
        count_ = count;
        add_geodesic();
        for (std::size_t axis = 0; axis < k_context_axes; ++axis) add_axis(axis);
    }

  private:
    using Lanes = LaneFloats<width>;
    static constexpr std::size_t k_panel_sums = k_face_block * k_slots;  // faces x slots, each `width` lanes

    std::size_t panels() const { return panel_count(tables_.classes, width); }
    Lanes* sums_of(std::size_t panel) { return reinterpret_cast<Lanes*>(sums_.data()) + panel * k_panel_sums; }

    void add_geodesic() {
        std::ranges::fill(sums_, 0.0f);
        for (std::size_t first = 0; first < tables_.samples; first += k_sample_block) {
            const std::size_t samples = std::min(k_sample_block, tables_.samples - first);
            copy_ranges(first, samples);
            for (std::size_t panel = 0; panel < panels(); ++panel)
                add_masses<width>(reinterpret_cast<const Lanes*>(tables_.mass.data()) + panel * tables_.samples + first,
                                  samples, ranges_.data(), sums_of(panel));
        }
        write(0);
    }

    // Neighboring faces share the cache lines of all samples.
    void copy_ranges(std::size_t first, std::size_t samples) {
        const ContextGeometry& geometry = *tables_.mesh.geometry;
        for (std::size_t j = 0; j < samples; ++j) {
            const std::uint8_t* from = geometry.geodesic_bin.data() + (first + j) * geometry.faces + first_;
            std::uint8_t* to = ranges_.data() + j * k_face_block;
            if (count_ == k_face_block)
                std::copy_n(from, k_face_block, to);
            else
                std::copy_n(from, count_, to);
        }
        for (std::uint8_t& range : ranges_) range = std::min<std::uint8_t>(range, k_context_bins);
    }

    void add_axis(std::size_t axis) {
        const ContextGeometry& geometry = *tables_.mesh.geometry;
        Positions positions{};
        std::copy_n(geometry.axis_position.data() + axis * geometry.faces + first_, count_, positions.begin());
        find_bounds(tables_, axis, positions, bounds_);
        for (std::size_t panel = 0; panel < panels(); ++panel) add_runs(axis, panel);
        write(1 + axis);
    }

    void add_runs(std::size_t axis, std::size_t panel) {
        const Lanes* prefix =
            reinterpret_cast<const Lanes*>(tables_.axes[axis].prefix.data()) + panel * (tables_.samples + 1);
        Lanes* const sums = sums_of(panel);
        const auto& [before, behind] = bounds_;
        for (std::size_t f = 0; f < count_; ++f)
            for (std::size_t b = 0; b < k_context_bins; ++b)
                sums[f * k_slots + b] = (prefix[behind[b + 1][f]] - prefix[behind[b][f]]) +
                                        (prefix[before[b][f]] - prefix[before[b + 1][f]]);
    }

    void write(std::size_t measure) {
        for (std::size_t b = 0; b < k_context_bins; ++b)
            for (std::size_t l = 0; l < tables_.classes; ++l) {
                const std::size_t column = (measure * k_context_bins + b) * tables_.classes + l;
                const float* sums = sums_.data() + (l / width * k_panel_sums + b) * width + l % width;
                float* out = tables_.mesh.out.data() + column * tables_.mesh.geometry->faces + first_;
                for (std::size_t f = 0; f < count_; ++f) out[f] = sums[f * k_slots * width];
            }
    }

    const Tables& tables_;
    std::size_t first_ = 0, count_ = 0;  // faces
    std::vector<std::uint8_t> ranges_;   // samples x faces of the block
    AlignedFloats sums_;                 // panels x faces of the block x slots x width
    Bounds bounds_;
};

template <int width>
void accumulate_fast(const ContextMesh& mesh, std::size_t classes) {
    const std::size_t faces = mesh.geometry->faces;
    Tables tables{mesh, classes, mesh.geometry->sample_face.size(), {}, {}};
    tables.mass = fast_masses<width>(tables);
    parallel_for(k_context_axes, [&](std::size_t axis) { tables.axes[axis] = sort_axis<width>(tables, axis); });
    parallel_ranges((faces + k_face_block - 1) / k_face_block, 4, [&](std::size_t first, std::size_t end) {
        FaceBlock<width> block(tables);
        for (std::size_t face = first * k_face_block; face < std::min(end * k_face_block, faces); face += k_face_block)
            block.accumulate(face, std::min(k_face_block, faces - face));
    });
}

}  // namespace

void FastContextHistograms::accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) {
    for (const ContextMesh& mesh : meshes) check_context(mesh, classes);
    for (const ContextMesh& mesh : meshes) {
        if (classes <= 4)
            accumulate_fast<4>(mesh, classes);
        else if (classes <= 8)
            accumulate_fast<8>(mesh, classes);
        else
            accumulate_fast<16>(mesh, classes);
    }
}

}  // namespace exemplar
