#pragma once

#include <cmath>
#include <utility>

namespace exemplar {

/// Golden-section search: returns where in [low, high] a function is smallest, and its value there. The function must
/// fall up to one place and rise after it. Each of the steps narrows the interval to 0.62 of its length, with one
/// evaluation; two precede them.
template <typename Function>
std::pair<double, double> golden_section_minimum(const Function& function, double low, double high, int steps) {
    const double golden = (std::sqrt(5.0) - 1) / 2;
    double left = high - golden * (high - low), right = low + golden * (high - low);
    double at_left = function(left), at_right = function(right);
    for (int step = 0; step < steps; ++step) {
        if (at_left < at_right) {
            high = right, right = left, at_right = at_left;
            at_left = function(left = high - golden * (high - low));
        } else {
            low = left, left = right, at_left = at_right;
            at_right = function(right = low + golden * (high - low));
        }
    }
    return at_left < at_right ? std::pair{left, at_left} : std::pair{right, at_right};
}

}  // namespace exemplar
