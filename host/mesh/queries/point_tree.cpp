#include "host/mesh/queries/point_tree.h"

#include <nanoflann.hpp>
#include <utility>

namespace exemplar {
namespace {

/// The points, with the interface that nanoflann requires.
struct Points {
    std::vector<Vec3> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

constexpr std::size_t k_leaf_size = 10;

}  // namespace

struct PointTree::Impl {
    Points points;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, std::uint32_t> tree;

    explicit Impl(std::vector<Vec3> of)
        : points{std::move(of)}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(k_leaf_size)) {}
};

PointTree::PointTree(std::vector<Vec3> points) : impl_(std::make_unique<Impl>(std::move(points))) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

std::uint32_t PointTree::nearest(const Vec3& point) const {
    std::uint32_t found = 0;
    float squared = 0;
    impl_->tree.knnSearch(point.data(), 1, &found, &squared);
    return found;
}

std::size_t PointTree::nearest(const Vec3& point, std::span<std::uint32_t> found) const {
    std::vector<float> squared(found.size());
    return impl_->tree.knnSearch(point.data(), found.size(), found.data(), squared.data());
}

}  // namespace exemplar
