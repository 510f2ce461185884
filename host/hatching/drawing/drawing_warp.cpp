#include "host/hatching/drawing/drawing_warp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/imaging/bilinear.h"

namespace exemplar {
namespace {

constexpr int k_max_samples = 64;  ///< samples per view pixel and axis

}  // namespace

Similarity::Similarity(double scale, double rotation, double x, double y)
    : cosine_(scale * std::cos(rotation)), sine_(scale * std::sin(rotation)), x_(x), y_(y) {}

double Similarity::scale() const {
    return std::hypot(cosine_, sine_);
}

double Similarity::rotation() const {
    return std::atan2(sine_, cosine_);
}

Similarity Similarity::inverse() const {
    const double squared = cosine_ * cosine_ + sine_ * sine_;
    Similarity inverse;
    inverse.cosine_ = cosine_ / squared, inverse.sine_ = -sine_ / squared;
    inverse.x_ = -(inverse.cosine_ * x_ - inverse.sine_ * y_);
    inverse.y_ = -(inverse.sine_ * x_ + inverse.cosine_ * y_);
    return inverse;
}

Similarity Similarity::then(const Similarity& next) const {
    Similarity both;
    both.cosine_ = next.cosine_ * cosine_ - next.sine_ * sine_;
    both.sine_ = next.sine_ * cosine_ + next.cosine_ * sine_;
    both.x_ = next.cosine_ * x_ - next.sine_ * y_ + next.x_;
    both.y_ = next.sine_ * x_ + next.cosine_ * y_ + next.y_;
    return both;
}

Similarity Similarity::moved(double x, double y) const {
    Similarity moved = *this;
    moved.x_ += x, moved.y_ += y;
    return moved;
}

FloatImage warp_drawing(const FloatImage& darkness, const Similarity& to_view, int width, int height) {
    if (darkness.channels != 1)
        throw UsageError(fmt::format("a drawing of {} channels; give its darkness", darkness.channels));
    if (width <= 0 || height <= 0) throw UsageError(fmt::format("a view of {} x {} pixels", width, height));
    const Similarity back = to_view.inverse();
    // Interpolated samples that are at most a pixel of the drawing apart weigh all pixels they cover alike.
    const int samples = std::clamp(static_cast<int>(std::ceil(back.scale() - 1e-6)), 1, k_max_samples);
    const float part = 1 / static_cast<float>(samples);
    FloatImage view(width, height, 1);
    parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
        for (int column = 0; column < width; ++column) {
            float sum = 0;
            for (int j = 0; j < samples; ++j)
                for (int i = 0; i < samples; ++i) {
                    const Vec2 place(static_cast<float>(column) + (static_cast<float>(i) + 0.5f) * part,
                                     static_cast<float>(row) + (static_cast<float>(j) + 0.5f) * part);
                    sum += sample_bilinear(darkness, back.apply(place), ImageBorder::zero);
                }
            view.pixel(column, static_cast<int>(row))[0] = sum / static_cast<float>(samples * samples);
        }
    });
    return view;
}

}  // namespace exemplar
