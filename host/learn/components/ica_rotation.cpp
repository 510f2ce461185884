#include "host/learn/components/ica_rotation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/learn/decompositions.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Replaces the components `u` by the derivative g = G' of the contrast function, and returns the mean of g' per
/// column, times the number of rows.
Eigen::RowVectorXd derivatives(MatrixXd& u, IcaContrast contrast) {
    auto g = u.array();
    switch (contrast) {
        case IcaContrast::log_cosh:
            g = 1.0 - 2.0 / ((2.0 * g).exp() + 1.0);  // tanh, several at a time
            return (1.0 - g.square()).colwise().sum().matrix();
        case IcaContrast::gauss: {
            const Eigen::ArrayXXd bell = (-0.5 * g.square()).exp();
            Eigen::RowVectorXd slope = ((1.0 - g.square()) * bell).colwise().sum().matrix();
            g *= bell;
            return slope;
        }
        default: {
            Eigen::RowVectorXd slope = (3.0 * g.square()).colwise().sum().matrix();
            g = g.cube();
            return slope;
        }
    }
}

/// One fixed-point step from each row w: E[g(w x) x] - E[g'(w x)] w. Blocks of samples are summed in order.
MatrixXd fixed_point_step(const MatrixXd& white, const MatrixXd& rows, IcaContrast contrast) {
    constexpr Index k_block = 2048;
    const Index samples = white.rows();
    std::vector<MatrixXd> parts(static_cast<std::size_t>((samples + k_block - 1) / k_block));
    parallel_for(parts.size(), [&](std::size_t b) {
        const Index begin = static_cast<Index>(b) * k_block;
        const auto block = white.middleRows(begin, std::min(k_block, samples - begin));
        MatrixXd u = block * rows.transpose();
        const Eigen::RowVectorXd slope = derivatives(u, contrast);
        parts[b] = u.transpose() * block - slope.asDiagonal() * rows;
    });
    for (std::size_t b = 1; b < parts.size(); ++b) parts[0] += parts[b];
    return parts[0] / static_cast<double>(samples);
}

/// The closest matrix with orthonormal rows: (W W^T)^-1/2 W, or by a singular value decomposition where W is nearly
/// singular.
MatrixXd nearest_rotation(const MatrixXd& rows) {
    constexpr double k_singular = 1e-8;
    const SymmetricEigen squared = symmetric_eigen(rows * rows.transpose());
    if (squared.values(0) > k_singular * squared.values(squared.values.size() - 1))
        return squared.inverse_sqrt() * rows;
    const SingularValues svd = singular_values(rows);
    return svd.u * svd.v.transpose();
}

/// Halves the step length when the changes have not become much smaller for a while, as the iteration oscillates.
class StepLength {
  public:
    double after(double change) {
        constexpr int k_patience = 60;
        if (change < 0.5 * least_) {
            least_ = change;
            waited_ = 0;
        } else if (++waited_ == k_patience) {
            length_ = std::max(0.5 * length_, 1.0 / 16);
            waited_ = 0;
        }
        return length_;
    }

  private:
    double least_ = 1, length_ = 1;
    int waited_ = 0;
};

IcaRotation rotate_together(const MatrixXd& white, MatrixXd rows, const IcaOptions& options) {
    StepLength step_length;
    for (int i = 1; i <= options.iterations; ++i) {
        MatrixXd next = nearest_rotation(fixed_point_step(white, rows, options.contrast));
        const VectorXd cosine = next.cwiseProduct(rows).rowwise().sum();
        const double change = (1 - cosine.cwiseAbs().array()).abs().maxCoeff();
        if (change < options.tolerance) return {next, true, i};
        const double length = step_length.after(change);
        if (length < 1) {
            for (Index d = 0; d < next.rows(); ++d) next.row(d) *= cosine(d) < 0 ? -length : length;
            next = nearest_rotation(next + (1 - length) * rows);
        }
        rows = next;
    }
    return {rows, false, options.iterations};
}

/// Makes `row` orthogonal to the first `count` rows and of unit length; returns false if nothing is left of it.
bool make_orthogonal(Eigen::RowVectorXd& row, const MatrixXd& rows, Index count) {
    constexpr double k_vanished = 1e-10;
    const double before = row.norm();
    for (int twice = 0; twice < 2; ++twice) row -= (row * rows.topRows(count).transpose()) * rows.topRows(count);
    const double after = row.norm();
    if (!(after > k_vanished * before)) return false;
    row /= after;
    return true;
}

struct DeflationEnd {
    bool converged;
    int iterations;
};

/// Finds row number `d`, orthogonal to those before, starting from rows.row(d).
DeflationEnd rotate_one(const MatrixXd& white, MatrixXd& rows, Index d, const IcaOptions& options) {
    StepLength step_length;
    Eigen::RowVectorXd row = rows.row(d);
    for (int i = 1; i <= options.iterations; ++i) {
        Eigen::RowVectorXd next = fixed_point_step(white, row, options.contrast);
        if (!make_orthogonal(next, rows, d)) return {false, i};
        const double cosine = next.dot(row);
        const double change = std::abs(1 - std::abs(cosine));
        const double length = step_length.after(change);
        if (change >= options.tolerance && length < 1) {
            next = (cosine < 0 ? -length : length) * next + (1 - length) * row;
            next.normalize();
        }
        row = rows.row(d) = next;
        if (change < options.tolerance) return {true, i};
    }
    return {false, options.iterations};
}

IcaRotation rotate_in_turn(const MatrixXd& white, MatrixXd rows, const IcaOptions& options) {
    IcaRotation out{std::move(rows), true, 0};
    for (Index d = 0; d < out.rows.rows(); ++d) {
        Eigen::RowVectorXd start = out.rows.row(d);
        // If the start depends on the rows before, any free axis will do.
        for (Index axis = 0; !make_orthogonal(start, out.rows, d); ++axis) {
            start = Eigen::RowVectorXd::Unit(out.rows.cols(), axis);
        }
        out.rows.row(d) = start;
        const DeflationEnd end = rotate_one(white, out.rows, d, options);
        out.converged = out.converged && end.converged;
        out.iterations = std::max(out.iterations, end.iterations);
    }
    return out;
}

MatrixXd random_rotation(Index size, std::uint64_t seed) {
    Random random(seed);
    MatrixXd rows(size, size);
    for (Index i = 0; i < size; ++i) {
        for (Index j = 0; j < size; ++j) rows(i, j) = random.normal();
    }
    return nearest_rotation(rows);
}

}  // namespace

IcaRotation find_rotation(const MatrixXd& white, const IcaOptions& options) {
    if (white.cols() == 0) return {MatrixXd(0, 0), true, 0};
    const MatrixXd start = random_rotation(white.cols(), options.seed);
    return options.scheme == IcaScheme::symmetric ? rotate_together(white, start, options)
                                                  : rotate_in_turn(white, start, options);
}

}  // namespace exemplar
