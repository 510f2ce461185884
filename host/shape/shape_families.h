#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/learn/feature_matrix.h"
#include "host/mesh/queries/rays.h"
#include "host/shape/inward_rays.h"
#include "host/shape/neighborhoods.h"
#include "host/shape/prepared_mesh.h"

/// Shape features that both labeling and hatching use (thesis App. A.1b-f, B.2), one source file each
/// (features_NAME.cpp). All read a PreparedMesh, compute a value for every face and do not depend on the number of
/// threads.
namespace exemplar {

constexpr std::size_t k_min_region_faces = 10;  ///< minimum faces of a PCA region

/// Returns "name@radius" with the radius as a share of the median distance, e.g. "curvature.k1@0.05".
std::string at_radius(const std::string& name, double share);

/// Local shape by principal component analysis (A.1b), 75 columns: for geodesic radii of 5, 10, 20, 30 and 50% of the
/// median distance the singular values s1 >= s2 >= s3 (standard deviations of the face centers, weighted by area, in
/// units of the radius) and the twelve ratios of the text. s2 and s3 are at least a hundredth of s1, so that ratios are
/// finite. Radii that hold many samples are measured from the samples' cells, the others from all faces, unless those
/// are too many for a neighborhood.
class PcaFamily {
  public:
    static constexpr std::array<double, 5> k_radii{0.05, 0.1, 0.2, 0.3, 0.5};
    /// Uses the first `radii` of these radii.
    explicit PcaFamily(const PreparedMesh& prepared, std::size_t radii = k_radii.size());
    float radius() const;  ///< radius of the neighborhoods that `measure` needs
    void measure(std::uint32_t face, Neighborhood neighborhood);
    void measure_large_radii();  ///< the radii that `measure` leaves out
    FeatureMatrix take() { return std::move(unary_); }
    /// Keeps the covariances too. Call it before measuring.
    void keep_covariances() { covariances_.assign(radii_, std::vector<std::array<float, 6>>(unary_.rows)); }
    /// Radii x faces: xx, xy, xz, yy, yz, zz, in squared normalized units; empty unless kept.
    std::vector<std::vector<std::array<float, 6>>> take_covariances() { return std::move(covariances_); }

  private:
    void keep(std::size_t scale, std::size_t face, const struct SurfaceMoments& moments);
    const PreparedMesh* prepared_;
    /// The first radius that a face's neighborhood does not fill; the area share of its faces.
    struct CutShort {
        std::size_t first_scale;
        double area_share;
    };
    std::size_t radii_, exact_radii_;
    std::vector<CutShort> cut_short_;  ///< F
    FeatureMatrix unary_;
    std::vector<std::vector<std::array<float, 6>>> covariances_;
};

/// Shape contexts (A.1f), 270 columns: area shares of the surface by geodesic distance (5 or 10 logarithmic ranges up
/// to the 95th percentile) and by the angle between the face's normal and the direction to the surface (4, 6 or 8
/// ranges). Near ranges are summed over all faces, as far as the neighborhood holds all, the others over the samples.
class ShapeContextFamily {
  public:
    static constexpr std::size_t k_rings = 10, k_sectors = 24;  ///< fine bins that all six histograms sum up
    explicit ShapeContextFamily(const PreparedMesh& prepared);
    float radius() const { return near_radius_; }  ///< radius of the neighborhoods that `measure` needs
    void measure(std::uint32_t face, Neighborhood neighborhood);
    void measure_far();                                          ///< adds the surface beyond the neighborhoods
    FeatureMatrix take();                                        ///< all six histograms
    FeatureMatrix take(std::size_t rings, std::size_t sectors);  ///< one of them

  private:
    const PreparedMesh* prepared_;
    std::array<float, k_rings + 1> edges_{};  ///< distance of each ring's inner edge, and of the last one's outer edge
    float near_radius_ = 0.0F;                ///< the ring edge from which samples are used
    std::vector<float> near_;                 ///< F: the distance from which samples are used
    std::vector<float> fine_;                 ///< faces x rings x sectors
};

/// Average geodesic distance (A.1e), 11 columns.
FeatureMatrix geodesic_features(const PreparedMesh& prepared);
/// Shape diameter (A.1c), 60 columns in [0, 1].
FeatureMatrix diameter_features(const PreparedMesh& prepared, const InwardRays& rays);
/// Distance from the medial surface (A.1d), 60 columns in [0, 1].
FeatureMatrix medial_features(const PreparedMesh& prepared, const RayScene& scene, const InwardRays& rays);
}  // namespace exemplar
