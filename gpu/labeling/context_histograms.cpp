#include "gpu/labeling/context_histograms.h"

#include <algorithm>
#include <span>

namespace exemplar {
namespace {

constexpr std::size_t k_columns_per_class = k_context_measures * k_context_bins;

// Returns the largest count, at least one, for which a demand is within the limits. Demands rise with the count.
template <typename Demand>
std::size_t largest_within(const DeviceInfo& info, std::size_t bytes, std::size_t most, Demand&& demand) {
    std::size_t low = 1, high = std::max<std::size_t>(most, 1);
    while (low < high) {
        const std::size_t middle = low + (high - low + 1) / 2;
        const ContextDemand needs = demand(middle);
        if (needs.bytes <= bytes && needs.texels <= info.max_texels)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

template <typename Use>
void for_each_range(std::size_t count, std::size_t step, Use&& use) {
    for (std::size_t first = 0; first < count; first += step) use(ContextRange{first, std::min(step, count - first)});
}

// Returns whether `b` directly follows `a`, both on the device and on the host.
bool continues(const BufferReadback& a, const BufferReadback& b) {
    return a.source == b.source && a.offset + a.target.size() == b.offset &&
           a.target.data() + a.target.size() == b.target.data();
}

// Adds a part to fetch, merged with the last one if possible.
void add_fetched(const BufferReadback& part, std::vector<BufferReadback>& parts) {
    if (!parts.empty() && continues(parts.back(), part))
        parts.back().target = {parts.back().target.data(), parts.back().target.size() + part.target.size()};
    else
        parts.push_back(part);
}

// Calls use(column, out) for the columns of a part's histograms: bins of all measures x classes of the part.
template <typename Part, typename Use>
void for_each_column(const Part& part, Use&& use) {
    const std::size_t all_faces = part.mesh->geometry->faces;
    for (std::size_t bin = 0; bin < k_columns_per_class; ++bin)
        for (std::size_t c = 0; c < part.classes.count; ++c) {
            const std::size_t column = bin * part.all_classes + part.classes.first + c;
            use(bin * part.classes.count + c,
                part.mesh->out.subspan(column * all_faces + part.faces.first, part.faces.count));
        }
}

}  // namespace

GpuContextHistograms::GpuContextHistograms(Device& device, Profiler* profiler, std::size_t tile_bytes)
    : device_(device), tile_bytes_(buffer_limit(device.info(), tile_bytes)), stream_(device, profiler) {}

void GpuContextHistograms::accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) {
    for (const ContextMesh& mesh : meshes) check_context(mesh, classes);
    std::vector<Part> parts;
    for (const ContextMesh& mesh : meshes) {
        if (mesh.geometry->sample_face.empty()) std::ranges::fill(mesh.out, 0.0f);
        add_parts(mesh, classes, parts);
    }
    if (!kernels_) kernels_.emplace(device_);
    for (std::span<const Part> left = parts; !left.empty();) {
        const std::size_t count = together(left);
        try {
            run(left.first(count));
        } catch (...) {
            stream_.discard();
            throw;
        }
        left = left.subspan(count);
    }
}

// Parts are in order of samples: the histograms of the first range are written to the output, those of later ranges
// are added. A part has as many samples as one face and four classes allow, then as many faces, then as many classes.
void GpuContextHistograms::add_parts(const ContextMesh& mesh, std::size_t classes, std::vector<Part>& parts) const {
    const auto most = [&](std::size_t count, auto&& demand) {
        return largest_within(device_.info(), tile_bytes_, count, demand);
    };
    const auto blocks_of = [](std::size_t count, std::size_t block) { return (count + block - 1) / block; };
    const std::size_t all_samples = mesh.geometry->sample_face.size(), all_faces = mesh.geometry->faces;
    const std::size_t sample_step =
        k_sample_block * most(blocks_of(std::min<std::size_t>(all_samples, k_max_iterations), k_sample_block),
                              [](std::size_t blocks) { return demand_of(k_sample_block * blocks, 1, k_class_block); });
    for_each_range(all_samples, sample_step, [&](ContextRange samples) {
        const std::size_t face_step =
            most(all_faces, [&](std::size_t faces) { return demand_of(samples.count, faces, k_class_block); });
        const std::size_t class_step = k_class_block * most(blocks_of(classes, k_class_block), [&](std::size_t blocks) {
                                           return demand_of(samples.count, face_step, k_class_block * blocks);
                                       });
        for_each_range(all_faces, face_step, [&](ContextRange faces) {
            for_each_range(classes, class_step, [&](ContextRange some) {
                parts.push_back({&mesh, classes, samples, faces, some});
            });
        });
    });
}

// Returns how many of the parts, at least one, fit into one submission.
std::size_t GpuContextHistograms::together(std::span<const Part> parts) const {
    std::size_t count = 0;
    ContextDemand all;
    for (const Part& part : parts) {
        const ContextDemand more = demand_of(part.samples.count, part.faces.count, part.classes.count);
        all.bytes += more.bytes;
        all.texels += more.texels;
        const bool fits =
            all.bytes <= tile_bytes_ && all.texels <= device_.info().max_texels && count < k_max_context_works;
        if (count > 0 && !fits) break;
        ++count;
    }
    return count;
}

void GpuContextHistograms::run(std::span<const Part> parts) {
    std::vector<ContextWork> works;
    works.reserve(parts.size());
    std::vector<float> probabilities;  // of the samples
    std::size_t geodesic_floats = 0;
    for (const Part& part : parts) {
        const ContextMesh& mesh = *part.mesh;
        ContextWork work{mesh.geometry,
                         part.samples,
                         part.faces,
                         part.classes,
                         {},
                         geodesic_floats,
                         k_context_axes * geodesic_floats,
                         part.faces.count};
        geodesic_floats += k_geodesic_columns * part.classes.count * part.faces.count;
        work.rows.reserve(part.samples.count);
        for (std::size_t j = 0; j < part.samples.count; ++j) {
            work.rows.push_back(static_cast<std::uint32_t>(probabilities.size() / part.all_classes));
            const std::size_t face = mesh.geometry->sample_face[part.samples.first + j];
            const auto row = mesh.probabilities.subspan(face * part.all_classes, part.all_classes);
            probabilities.insert(probabilities.end(), row.begin(), row.end());
        }
        works.push_back(std::move(work));
    }
    kernels_->upload(stream_, works, geodesic_floats);
    reserve(device_, probabilities_, probabilities.size() * sizeof(float));
    stream_.upload<float>(probabilities_, probabilities);
    kernels_->record(stream_, probabilities_, parts.front().all_classes);
    fetch(parts, works);
}

void GpuContextHistograms::fetch(std::span<const Part> parts, std::span<const ContextWork> works) {
    std::size_t later = 0;
    for (const Part& part : parts)
        if (part.samples.first > 0) later += k_columns_per_class * part.classes.count * part.faces.count;
    later_.resize(later);
    struct Sum {
        std::span<float> out;
        std::span<const float> added;
    };
    std::vector<Sum> sums;
    std::vector<BufferReadback> fetched;
    later = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        for_each_column(parts[i], [&](std::size_t column, std::span<float> out) {
            std::span<float> target = out;
            if (parts[i].samples.first > 0) {
                target = std::span(later_).subspan(later, out.size());
                sums.push_back({out, target});
                later += out.size();
            }
            const std::size_t of_geodesic = k_geodesic_columns * parts[i].classes.count;
            const bool geodesic = column < of_geodesic;
            const std::size_t first = geodesic ? works[i].first_geodesic + column * out.size()
                                               : works[i].first_axes + (column - of_geodesic) * out.size();
            add_fetched({geodesic ? &kernels_->geodesic() : &kernels_->axes(), first * sizeof(float),
                         std::as_writable_bytes(target)},
                        fetched);
        });
    stream_.fetch(fetched);
    for (const Sum& sum : sums)
        for (std::size_t f = 0; f < sum.out.size(); ++f) sum.out[f] += sum.added[f];
}

}  // namespace exemplar
