#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/hatching/features/hatching_surface.h"
#include "host/hatching/features/hatching_view.h"
#include "host/hatching/features/image_tools.h"
#include "host/hatching/features/orientation_fields.h"
#include "host/learn/feature_matrix.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// Scalar features of a pixel (thesis App. B.2), without their powers (see powers.h).
constexpr std::size_t k_curvature_features = k_view_curvature_columns, k_descriptor_features = 110,
                      k_image_features = 53, k_line_features = 48;
constexpr std::size_t k_pixel_features =
    k_curvature_features + k_descriptor_features + k_image_features + k_line_features;  // 301

/// Returns the names of the scalar features, in order; e.g. "curvature.mean@0.01", "image.L.N@2",
/// "lines.ridges>0.01@5".
const std::vector<std::string>& pixel_feature_names();
/// Returns the name of the feature that tells whether a pixel shows a part.
std::string part_feature_name(const std::string& part);
/// Returns the names of the k_orientation_features, as in the legend of thesis Fig. 4.3: for example "k_max,1" and
/// "perp k_max,1".
const std::vector<std::string>& orientation_feature_names();

/// The features of the pixels of a view that show the surface. Images and fields are computed on first use.
class PixelFeatures {
  public:
    /// Keeps references to all three. Throws DataError if the view does not show the surface.
    PixelFeatures(const HatchingSurface& surface, const HatchingView& view, ImageTools& tools);
    PixelFeatures(const HatchingSurface& surface, HatchingView&& view, ImageTools& tools) = delete;
    ~PixelFeatures();

    const HatchingSurface& surface() const { return surface_; }
    const HatchingView& view() const { return view_; }
    const GBuffer& gbuffer() const { return gbuffer_; }
    const CoveredPixels& pixels() const { return pixels_; }
    std::size_t size() const { return pixels_.pixel.size(); }

    /// Sets how many pixels of this view correspond to one of the view that a style was learned from; 1 at first. Image
    /// filters are as many times as wide, and derivatives are per pixel of that view. So features do not depend on the
    /// size of the picture. Limited to [1/16, 8].
    void set_scale(float scale);

    /// Sets the labels of the surface's parts, one per face of the surface or of the file that it came from. Throws
    /// UsageError if there are as many of neither.
    void set_labels(const FaceLabels& labels);
    /// Returns the names of the labels that are set; none at first.
    const std::vector<std::string>& label_names() const { return label_names_; }
    /// Adds a scalar feature for each of these parts, after the others: 1 where a pixel shows that part, else 0. No
    /// parts: none. Throws UsageError, in terms of the command line, if there are parts, but no labels, or none that
    /// has the name of a part.
    void use_parts(std::span<const std::string> parts);
    /// Returns the number of scalar features, those of parts included.
    std::size_t scalar_count() const { return k_pixel_features + parts_.size(); }

    /// Returns the scalar features `which` of the pixels pixels().pixel[rows[i]]; of all pixels if there are no
    /// rows. There is memory for `spare` more columns, so that they can be appended without a copy.
    FeatureMatrix scalars(std::span<const std::uint32_t> which, std::span<const std::uint32_t> rows,
                          std::size_t spare = 0);
    /// Returns all orientation features of those pixels. Where an image has no gradient, the direction is completed
    /// from its surroundings.
    OrientationFields orientations(std::span<const std::uint32_t> rows);

  private:
    struct Computed;
    FacePoints points(std::span<const std::uint32_t> rows) const;
    const ImageStack& shading();
    const ImageDerivatives& derivatives(std::size_t sigma);
    const ImageStack& line_drawings(std::size_t kind);
    void blur_lines(std::span<const std::uint32_t> features);
    std::vector<DoubledAngle> gradient_directions(std::span<const float> x, std::span<const float> y) const;
    void part_column(std::size_t part, const FacePoints& points, std::span<float> out) const;
    void picture_column(std::size_t feature, std::span<const std::uint32_t> rows, std::span<float> out);
    const HatchingSurface& surface_;
    const HatchingView& view_;
    ImageTools& tools_;
    GBuffer gbuffer_;
    CoveredPixels pixels_;
    float scale_ = 1;
    std::vector<std::string> label_names_, parts_;
    std::vector<std::int32_t> label_;  // per face, the number of its label; -1: none
    std::vector<std::int32_t> part_;   // per label, the number of its part; -1: none
    std::unique_ptr<Computed> computed_;
};

}  // namespace exemplar
