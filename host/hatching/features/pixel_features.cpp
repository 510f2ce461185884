#include "host/hatching/features/pixel_features.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/features/direction_completion.h"
#include "host/hatching/features/direction_smoothing.h"
#include "host/hatching/features/line_directions.h"
#include "host/hatching/features/line_images.h"
#include "host/hatching/features/pixel_projection.h"
#include "host/imaging/gaussian.h"

namespace exemplar {
namespace {

/// The images that gradients and curvatures are taken of.
enum ShadingImage : std::size_t { k_intensity, k_view_normal, k_light_normal, k_ambient, k_shading_images };
constexpr std::array<const char*, k_shading_images> k_shading_names{"I", "V.N", "L.N", "a"};
constexpr std::array<float, 4> k_sigmas{1, 2, 3, 5};
constexpr std::array<float, 3> k_line_sigmas{5, 10, 20};

constexpr std::size_t k_first_descriptor = k_curvature_features,
                      k_first_image = k_first_descriptor + k_descriptor_features,
                      k_first_line = k_first_image + k_image_features;

/// An image feature: a quantity of a shading image at a scale, or depth.
struct ImageFeature {
    enum Quantity { value, gradient, curvature_max, curvature_min, depth } quantity;
    std::size_t image, sigma;
};

/// The 53 of App. B.2, in their order.
std::vector<ImageFeature> image_features() {
    using F = ImageFeature;
    std::vector<F> all;
    const auto add = [&](F::Quantity quantity, std::size_t image) {
        for (std::size_t s = 0; s < k_sigmas.size(); ++s) all.push_back({quantity, image, s});
    };
    for (const auto quantity : {F::curvature_max, F::curvature_min, F::value, F::gradient}) add(quantity, k_intensity);
    for (const auto image : {k_view_normal, k_light_normal, k_ambient}) add(F::value, image);
    for (const auto image : {k_view_normal, k_light_normal}) {
        for (const auto quantity : {F::gradient, F::curvature_max, F::curvature_min}) add(quantity, image);
    }
    all.push_back({F::depth, 0, 0});
    return all;
}

std::string name_of(const ImageFeature& feature) {
    if (feature.quantity == ImageFeature::depth) return "image.depth";
    constexpr std::array<const char*, 4> k_patterns{"image.{}", "image.|grad {}|", "image.curvature_max {}",
                                                    "image.curvature_min {}"};
    const std::string name = fmt::format(fmt::runtime(k_patterns[feature.quantity]), k_shading_names[feature.image]);
    return fmt::format("{}@{}", name, k_sigmas[feature.sigma]);
}

std::vector<std::string> all_names() {
    std::vector<std::string> names = view_curvature_names();
    for (std::string& name : descriptor_names()) names.push_back(std::move(name));
    for (const ImageFeature& feature : image_features()) names.push_back(name_of(feature));
    for (std::size_t kind = 0; kind < k_line_kinds; ++kind) {
        for (std::size_t step = 0; step < k_line_thresholds; ++step) {
            for (const float sigma : k_line_sigmas)
                names.push_back(
                    fmt::format("lines.{}>{:.2g}@{}", line_kind_name(kind), line_threshold(kind, step), sigma));
        }
    }
    return names;
}

/// The fields per vertex: those of the thesis, before the gradients of images, and one more, after them.
constexpr std::size_t k_vertex_fields = 19;
constexpr std::size_t k_slice_field = k_thesis_fields, k_first_constant = k_slice_field + 1;

std::vector<std::string> all_orientation_names() {
    std::vector<std::string> names;
    for (const char* field : {"k_max", "k_min", "e_a", "e_b"}) {
        for (int scale = 1; scale <= 3; ++scale) names.push_back(fmt::format("{},{}", field, scale));
    }
    for (const char* field : {"LxN", "VxN", "L", "E", "s", "r", "v"}) names.emplace_back(field);
    for (const char* image : {"V.N", "L.N", "a", "I"}) {
        for (int scale = 1; scale <= 4; ++scale) names.push_back(fmt::format("grad {},{}", image, scale));
    }
    const auto add_rotated = [&](std::size_t first) {
        const std::size_t end = names.size();
        for (std::size_t k = first; k < end; ++k) names.push_back("perp " + names[k]);
    };
    add_rotated(0);
    for (const char* field : {"UxN", "x", "diagonal"}) names.emplace_back(field);
    add_rotated(2 * k_thesis_fields);
    return names;
}

}  // namespace

const std::vector<std::string>& pixel_feature_names() {
    static const std::vector<std::string> k_names = all_names();
    return k_names;
}

std::string part_feature_name(const std::string& part) {
    return "part." + part;
}

const std::vector<std::string>& orientation_feature_names() {
    static const std::vector<std::string> k_names = all_orientation_names();
    return k_names;
}

/// Results that are computed on first use.
struct PixelFeatures::Computed {
    ImageStack shading;
    std::array<std::optional<ImageDerivatives>, k_sigmas.size()> derivatives;
    std::optional<LineImages> lines;
    // One image per threshold: filters process all of them side by side, for little more than the cost of one.
    std::array<std::optional<ImageStack>, k_line_kinds> drawn;
    std::array<std::array<std::optional<ImageStack>, k_line_sigmas.size()>, k_line_kinds> line_images;
    // Per vertex.
    std::optional<std::array<std::vector<Vec3>, k_vertex_fields + 1>> fields;
};

namespace {

/// What a feature of lines comes from.
struct LineFeature {
    std::size_t kind, threshold, sigma;
};
LineFeature line_feature(std::size_t feature) {
    const std::size_t place = feature - k_first_line, line = place / k_line_sigmas.size();
    return {line / k_line_thresholds, line % k_line_thresholds, place % k_line_sigmas.size()};
}

/// The computation that a feature comes from.
enum class Source { curvature, descriptors, picture, parts };
Source source_of(std::size_t feature) {
    if (feature < k_first_descriptor) return Source::curvature;
    if (feature < k_first_image) return Source::descriptors;
    return feature < k_pixel_features ? Source::picture : Source::parts;
}

/// Returns the longest run of leading features that share the source of the first.
std::span<const std::uint32_t> same_source(std::span<const std::uint32_t> features) {
    const auto other =
        std::ranges::find_if(features, [&](std::uint32_t k) { return source_of(k) != source_of(features.front()); });
    return features.first(static_cast<std::size_t>(other - features.begin()));
}

std::vector<std::uint32_t> descriptors_of(std::span<const std::uint32_t> features) {
    std::vector<std::uint32_t> columns;
    for (const std::uint32_t k : features) columns.push_back(k - static_cast<std::uint32_t>(k_first_descriptor));
    return columns;
}

/// Fills columns of a feature matrix from images at some of the pixels.
class Gatherer {
  public:
    Gatherer(const PixelFeatures& pixels, std::span<const std::uint32_t> rows)
        : pixels_(pixels), rows_(rows), count_(rows.empty() ? pixels.size() : rows.size()) {}
    std::size_t count() const { return count_; }
    std::uint32_t pixel(std::size_t i) const { return pixels_.pixels().pixel[rows_.empty() ? i : rows_[i]]; }

    template <typename ValueAt>
    void from_pixels(ValueAt&& value_at, std::span<float> out) const {
        parallel_for(
            count_, [&](std::size_t i) { out[i] = value_at(pixel(i)); }, 16384);
    }

  private:
    const PixelFeatures& pixels_;
    std::span<const std::uint32_t> rows_;
    std::size_t count_;
};

/// Computes the fields that are defined on the surface: those of App. B.3 in their order, and horizontal slices.
std::array<std::vector<Vec3>, k_vertex_fields + 1> vertex_fields(const HatchingSurface& surface,
                                                                 const HatchingView& view, const LineImages& lines) {
    std::array<std::vector<Vec3>, k_vertex_fields + 1> fields;
    for (std::size_t s = 0; s < 3; ++s) {
        fields[s] = surface.directions.k_max[s];
        fields[3 + s] = surface.directions.k_min[s];
        fields[6 + s] = surface.directions.e_a[s];
        fields[9 + s] = surface.directions.e_b[s];
    }
    const DirectionSmoother smoother(surface.mesh, surface.normals);
    const std::size_t count = surface.mesh.vertex_count();
    const auto across = [&](auto&& direction_at) {
        std::vector<Vec3> directions(count);
        std::vector<float> confidence(count);
        for (std::size_t v = 0; v < count; ++v) {
            directions[v] = direction_at(v).cross(surface.normals[v]);
            confidence[v] = direction_confidence(directions[v].norm());
        }
        return smoother.complete(directions, confidence);
    };
    parallel_for(4, [&](std::size_t k) {
        if (k == 0) fields[12] = across([&](std::size_t) { return view.light; });
        if (k == 1) fields[13] = across([&](std::size_t v) { return view.camera.to_eye(surface.mesh.vertices[v]); });
        if (k == 3) fields[k_vertex_fields] = across([&](std::size_t) { return view.up; });
        if (k == 2) {
            std::vector<LineSegment> segments = lines.segments(LineType::contours, 0);
            const std::vector<LineSegment> suggestive =
                lines.segments(LineType::suggestive_contours, LineThresholds{}.suggestive_contours);
            segments.insert(segments.end(), suggestive.begin(), suggestive.end());
            fields[16] = complete_line_directions(smoother, surface, segments);
        }
    });
    fields[14].assign(count, view.light);
    fields[15] = vector_irradiance(surface.occlusion, view.light);
    fields[17] = surface.directions.ridges;
    fields[18] = surface.directions.valleys;
    return fields;
}

}  // namespace

PixelFeatures::PixelFeatures(const HatchingSurface& surface, const HatchingView& view, ImageTools& tools)
    : surface_(surface),
      view_(view),
      tools_(tools),
      gbuffer_(tools.gbuffers.render(surface.mesh, view.camera, view.width, view.height)),
      pixels_(covered_pixels(gbuffer_)),
      computed_(std::make_unique<Computed>()) {
    if (pixels_.pixel.empty())
        throw DataError("the view shows nothing of the mesh; turn the camera to it or move it away");
}

PixelFeatures::~PixelFeatures() = default;

void PixelFeatures::set_scale(float scale) {
    scale = std::clamp(scale, 1.0f / 16, 8.0f);
    if (scale == scale_) return;
    scale_ = scale;
    for (auto& derivatives : computed_->derivatives) derivatives.reset();
    for (auto& images : computed_->line_images) {
        for (auto& image : images) image.reset();
    }
}

void PixelFeatures::set_labels(const FaceLabels& labels) {
    const TriangleMesh& mesh = surface_.mesh;
    const bool of_file = labels.label.size() == mesh.source_face_count;
    if (!of_file && labels.label.size() != mesh.face_count())
        throw UsageError(
            fmt::format("{} labels are not of a mesh with {} faces", labels.label.size(), mesh.source_face_count));
    label_names_ = labels.names;
    label_.resize(mesh.face_count());
    for (std::size_t f = 0; f < label_.size(); ++f)
        label_[f] = labels.label[of_file ? mesh.source_of(static_cast<std::uint32_t>(f)) : f];
    part_.assign(label_names_.size(), -1);
}

void PixelFeatures::use_parts(std::span<const std::string> parts) {
    parts_.assign(parts.begin(), parts.end());
    if (parts_.empty()) return;
    if (label_names_.empty())
        throw UsageError(
            fmt::format("the style was learned with labels of parts ({}), and needs those of this mesh: give "
                        "them by --labels",
                        fmt::join(parts_, ", ")));
    bool any = false;
    for (std::size_t c = 0; c < part_.size(); ++c) {
        const auto found = std::ranges::find(parts_, label_names_[c]);
        part_[c] = found == parts_.end() ? -1 : static_cast<std::int32_t>(found - parts_.begin());
        any = any || part_[c] >= 0;
    }
    if (!any)
        throw UsageError(
            fmt::format("none of the labels of this mesh ({}) is a part that the style was learned with ({})",
                        fmt::join(label_names_, ", "), fmt::join(parts_, ", ")));
}

void PixelFeatures::part_column(std::size_t part, const FacePoints& points, std::span<float> out) const {
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::int32_t label = label_[points.face[i]];
        const bool is_it = label >= 0 && part_[static_cast<std::size_t>(label)] == static_cast<std::int32_t>(part);
        out[i] = is_it ? 1.0f : 0.0f;
    }
}

FacePoints PixelFeatures::points(std::span<const std::uint32_t> rows) const {
    const Gatherer gatherer(*this, rows);
    FacePoints points{std::vector<std::uint32_t>(gatherer.count()),
                      std::vector<std::array<float, 2>>(gatherer.count())};
    for (std::size_t i = 0; i < points.size(); ++i) {
        points.face[i] = gbuffer_.face[gatherer.pixel(i)];
        points.barycentric[i] = gbuffer_.barycentric[gatherer.pixel(i)];
    }
    return points;
}

const ImageStack& PixelFeatures::shading() {
    ImageStack& shading = computed_->shading;
    if (shading.count > 0) return shading;
    const std::vector<float> bright = shade(surface_.occlusion, view_.light);
    shading = ImageStack(view_.width, view_.height, k_shading_images);
    const FacePoints all = points({});
    parallel_for(
        all.size(),
        [&](std::size_t i) {
            const std::uint32_t pixel = pixels_.pixel[i];
            const Vec3 normal = interpolate(surface_.mesh, all, i, surface_.normals).normalized();
            const Vec3 point = interpolate(surface_.mesh, all, i, surface_.mesh.vertices);
            shading.image(k_intensity)[pixel] = interpolate(surface_.mesh, all, i, bright);
            shading.image(k_view_normal)[pixel] = std::max(normal.dot(view_.camera.to_eye(point)), 0.0f);
            shading.image(k_light_normal)[pixel] = std::max(normal.dot(view_.light), 0.0f);
            shading.image(k_ambient)[pixel] = interpolate(surface_.mesh, all, i, surface_.occlusion.ambient);
        },
        4096);
    return shading;
}

const ImageDerivatives& PixelFeatures::derivatives(std::size_t sigma) {
    auto& kept = computed_->derivatives[sigma];
    if (!kept)
        kept = tools_.filters.derivatives(shading(), gbuffer_.face, std::max(k_min_sigma, scale_ * k_sigmas[sigma]),
                                          false);
    return *kept;
}

const ImageStack& PixelFeatures::line_drawings(std::size_t kind) {
    auto& kept = computed_->drawn[kind];
    if (kept) return *kept;
    if (!computed_->lines) computed_->lines.emplace(surface_, view_);
    ImageStack drawn(view_.width, view_.height, k_line_thresholds);
    parallel_for(k_line_thresholds, [&](std::size_t step) {
        std::ranges::copy(computed_->lines->draw(kind, step).data, drawn.image(step).begin());
    });
    kept = std::move(drawn);
    return *kept;
}

/// Computes the blurred images of lines that features need, all of one kind at once, as a device waits after each call.
void PixelFeatures::blur_lines(std::span<const std::uint32_t> features) {
    std::array<std::array<bool, k_line_sigmas.size()>, k_line_kinds> missing{};
    for (const std::uint32_t feature : features) {
        if (feature < k_first_line || feature >= k_pixel_features) continue;
        const LineFeature line = line_feature(feature);
        missing[line.kind][line.sigma] = !computed_->line_images[line.kind][line.sigma];
    }
    for (std::size_t kind = 0; kind < k_line_kinds; ++kind) {
        std::vector<std::size_t> places;
        std::vector<float> sigmas;
        for (std::size_t sigma = 0; sigma < k_line_sigmas.size(); ++sigma) {
            if (!missing[kind][sigma]) continue;
            places.push_back(sigma);
            sigmas.push_back(std::max(k_min_sigma, scale_ * k_line_sigmas[sigma]));
        }
        if (places.empty()) continue;
        std::vector<ImageStack> blurred = tools_.filters.blurred(line_drawings(kind), sigmas);
        for (std::size_t i = 0; i < places.size(); ++i) computed_->line_images[kind][places[i]] = std::move(blurred[i]);
    }
}

void PixelFeatures::picture_column(std::size_t feature, std::span<const std::uint32_t> rows, std::span<float> out) {
    const Gatherer gatherer(*this, rows);
    if (feature >= k_first_line) {
        const LineFeature line = line_feature(feature);
        const std::span<const float> image = computed_->line_images[line.kind][line.sigma]->image(line.threshold);
        // Length of lines per area.
        return gatherer.from_pixels([&](std::uint32_t pixel) { return scale_ * image[pixel]; }, out);
    }
    static const std::vector<ImageFeature> k_features = image_features();
    const auto [quantity, image, sigma] = k_features[feature - k_first_image];
    if (quantity == ImageFeature::depth) {
        // Relative to the object's center, in units of its radius: so it depends on neither mesh scale nor eye
        // distance.
        const BoundingBox box = bounding_box(surface_.mesh);
        const Vec3 middle = (0.5 * (box.low + box.high)).cast<float>();
        const float away = -(view_.camera.view * middle.homogeneous()).z();
        const float radius = std::max(0.5f * static_cast<float>(box.diagonal()), 1e-20f);
        return gatherer.from_pixels([&](std::uint32_t pixel) { return (gbuffer_.depth[pixel] - away) / radius; }, out);
    }
    const ImageDerivatives& all = derivatives(sigma);
    const std::array<const ImageStack*, 4> quantities{&all.value, &all.gradient_magnitude, &all.maximum_curvature,
                                                      &all.minimum_curvature};
    const std::span<const float> values = quantities[quantity]->image(image);
    const float unit = std::array<float, 4>{1, scale_, scale_ * scale_, scale_ * scale_}[quantity];
    gatherer.from_pixels([&](std::uint32_t pixel) { return unit * values[pixel]; }, out);
}

std::vector<DoubledAngle> PixelFeatures::gradient_directions(std::span<const float> x, std::span<const float> y) const {
    std::vector<DoubledAngle> directions(x.size());
    std::atomic<bool> complete = true;
    const auto set = [&](std::size_t i) {
        const std::uint32_t pixel = pixels_.pixel[i];
        const Vec2 gradient(x[pixel], y[pixel]);
        // A picture that is flat to a millionth has no gradient.
        if (gradient.norm() > 1e-6f)
            directions[pixel] = doubled_angle(gradient.normalized());
        else
            complete = false;
    };
    parallel_for(size(), set, 16384);
    if (!complete) complete_directions(view_.width, view_.height, directions);
    return directions;
}

OrientationFields PixelFeatures::orientations(std::span<const std::uint32_t> rows) {
    if (!computed_->lines) computed_->lines.emplace(surface_, view_);
    if (!computed_->fields) computed_->fields = vertex_fields(surface_, view_, *computed_->lines);
    const Gatherer gatherer(*this, rows);
    OrientationFields out(gatherer.count());
    const FacePoints at = points(rows);
    const std::vector<std::span<const Vec3>> fields(computed_->fields->begin(), computed_->fields->end());
    const auto project = [&](std::span<const std::span<const Vec3>> some, std::size_t first) {
        tools_.projection.directions(surface_.mesh, view_, at, some,
                                     std::span(out.values).subspan(first * out.rows, some.size() * out.rows));
    };
    project(std::span(fields).first(k_vertex_fields), 0);
    project(std::span(fields).subspan(k_vertex_fields), k_slice_field);
    // Directions that are the same all over the picture: along the axes, and between them.
    std::ranges::fill(out.field(k_first_constant), DoubledAngle{1, 0});
    std::ranges::fill(out.field(k_first_constant + 1), DoubledAngle{0, 1});
    constexpr std::array<std::size_t, k_shading_images> k_order{k_view_normal, k_light_normal, k_ambient, k_intensity};
    for (std::size_t k = k_vertex_fields; k < k_thesis_fields; ++k) {
        const std::size_t place = k - k_vertex_fields;
        const ImageDerivatives& all = derivatives(place % k_sigmas.size());
        const std::size_t image = k_order[place / k_sigmas.size()];
        const std::span<const float> x = all.gradient_x.image(image), y = all.gradient_y.image(image);
        const std::vector<DoubledAngle> directions = gradient_directions(x, y);
        for (std::size_t i = 0; i < out.rows; ++i) out.field(k)[i] = directions[gatherer.pixel(i)];
    }
    return out;
}

FeatureMatrix PixelFeatures::scalars(std::span<const std::uint32_t> which, std::span<const std::uint32_t> rows,
                                     std::size_t spare) {
    const FacePoints at = points(rows);
    FeatureMatrix out;
    out.rows = at.size();
    for (const std::uint32_t k : which)
        out.names.push_back(k < k_pixel_features ? pixel_feature_names()[k]
                                                 : part_feature_name(parts_.at(k - k_pixel_features)));
    out.values.reserve(out.rows * (which.size() + spare));
    out.values.resize(out.rows * which.size());
    blur_lines(which);
    for (std::size_t first = 0; first < which.size();) {
        const std::span<const std::uint32_t> some = same_source(which.subspan(first));
        const std::span<float> columns(out.values.data() + first * out.rows, some.size() * out.rows);
        switch (source_of(some.front())) {
            case Source::curvature:
                tools_.projection.curvature(surface_, view_, at, some, columns);
                break;
            case Source::descriptors:
                tools_.projection.scalars(surface_.mesh, at, surface_.descriptors, descriptors_of(some), columns);
                break;
            case Source::picture:
                for (std::size_t k = 0; k < some.size(); ++k)
                    picture_column(some[k], rows, columns.subspan(k * out.rows, out.rows));
                break;
            case Source::parts:
                for (std::size_t k = 0; k < some.size(); ++k)
                    part_column(some[k] - k_pixel_features, at, columns.subspan(k * out.rows, out.rows));
                break;
        }
        first += some.size();
    }
    return out;
}

}  // namespace exemplar
