#include "host/imaging/vectors/path_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;

constexpr double k_max_coordinate = 1e9;

/// Takes numbers, flags and commands from a text.
class PathText {
  public:
    explicit PathText(std::string_view text) : text_(text) {}

    bool ended() {
        skip();
        return at_ == text_.size();
    }
    /// Whether a number follows.
    bool has_number() {
        skip();
        return at_ < text_.size() &&
               (text_[at_] == '-' || text_[at_] == '+' || text_[at_] == '.' || is_digit(text_[at_]));
    }
    char letter() {
        skip();
        return text_[at_++];
    }
    double number() {
        if (!has_number()) fail("a number is missing");
        const std::size_t start = at_ + (text_[at_] == '+' ? 1 : 0);
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + start, text_.data() + text_.size(), value);
        if (error != std::errc() || !(std::abs(value) <= k_max_coordinate)) fail("not a number that can be drawn");
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }
    Vector2d point() {
        const double x = number();
        return {x, number()};
    }
    /// A 0 or 1, which needs no separator.
    bool flag() {
        skip();
        if (at_ == text_.size() || (text_[at_] != '0' && text_[at_] != '1')) fail("a flag of an arc is missing");
        return text_[at_++] == '1';
    }
    [[noreturn]] void fail(const char* why) const { throw UsageError(fmt::format("{} at character {}", why, at_ + 1)); }

  private:
    static bool is_digit(char c) { return c >= '0' && c <= '9'; }
    void skip() {
        while (at_ < text_.size() && std::string_view(" \t\r\n\f,").find(text_[at_]) != std::string_view::npos) ++at_;
    }
    std::string_view text_;
    std::size_t at_ = 0;
};

/// Follows the commands of a path.
class PathFollower {
  public:
    PathFollower(std::string_view data, double tolerance) : text_(data), tolerance_(tolerance) {}

    std::vector<Polyline> lines() {
        char command = 0;
        while (!text_.ended()) {
            if (!text_.has_number())
                command = text_.letter();
            else if (command == 0 || command == 'Z' || command == 'z')
                text_.fail("a command is missing");
            follow(command);
            // Further pairs of numbers after a move are lines.
            if (command == 'M') command = 'L';
            if (command == 'm') command = 'l';
        }
        std::erase_if(lines_, [](const Polyline& line) { return line.points.size() < 2; });
        return std::move(lines_);
    }

  private:
    void follow(char command) {
        const bool relative = command >= 'a';
        const Vector2d base = relative ? here_ : Vector2d::Zero();
        const char kind = relative ? static_cast<char>(command - 'a' + 'A') : command;
        if (kind != 'M' && lines_.empty()) text_.fail("a path begins with a move");
        switch (kind) {
            case 'M':
                move_to(base + text_.point());
                break;
            case 'Z':
                close();
                break;
            case 'L':
                line_to(base + text_.point());
                break;
            case 'H':
                line_to({base.x() + text_.number(), here_.y()});
                break;
            case 'V':
                line_to({here_.x(), base.y() + text_.number()});
                break;
            default:
                follow_curve(kind, base);
        }
        if (kind != 'C' && kind != 'S') cubic_control_ = here_;
        if (kind != 'Q' && kind != 'T') quadratic_control_ = here_;
    }

    void follow_curve(char kind, const Vector2d& base) {
        if (kind == 'C' || kind == 'S') {
            const Vector2d first = kind == 'C' ? Vector2d(base + text_.point()) : Vector2d(2 * here_ - cubic_control_);
            const Vector2d second = base + text_.point(), end = base + text_.point();
            curve_to(first, second, end);
            cubic_control_ = second;
        } else if (kind == 'Q' || kind == 'T') {
            const Vector2d control =
                kind == 'Q' ? Vector2d(base + text_.point()) : Vector2d(2 * here_ - quadratic_control_);
            const Vector2d end = base + text_.point();
            curve_to(here_ + 2.0 / 3 * (control - here_), end + 2.0 / 3 * (control - end), end);
            quadratic_control_ = control;
        } else if (kind == 'A') {
            const Vector2d radii = text_.point().cwiseAbs();
            const double turn = text_.number() * std::numbers::pi / 180;
            const bool large = text_.flag(), clockwise = text_.flag();
            arc_to(radii, turn, large, clockwise, base + text_.point());
        } else {
            text_.fail("an unknown command");
        }
    }

    void move_to(const Vector2d& to) {
        lines_.push_back({{to}, false});
        here_ = begin_ = to;
    }
    void close() {
        Polyline& line = lines_.back();
        if (line.points.size() > 1) line.closed = true;
        if (line.closed && (line.points.back() - begin_).norm() < tolerance_) line.points.pop_back();
        here_ = begin_;
    }
    void line_to(const Vector2d& to) {
        if (lines_.back().closed) move_to(here_);
        lines_.back().points.push_back(to);
        here_ = to;
    }
    void curve_to(const Vector2d& first, const Vector2d& second, const Vector2d& end) {
        const Vector2d start = here_;
        const double bend = std::max((start - 2 * first + second).norm(), (first - 2 * second + end).norm());
        constexpr double k_most = 64;
        const int pieces = static_cast<int>(std::clamp(std::ceil(std::sqrt(0.75 * bend / tolerance_)), 1.0, k_most));
        for (int i = 1; i <= pieces; ++i) {
            const double t = static_cast<double>(i) / pieces, s = 1 - t;
            line_to(s * s * s * start + 3 * s * s * t * first + 3 * s * t * t * second + t * t * t * end);
        }
    }
    /// An arc of an ellipse (SVG 1.1, appendix F.6), as curves of at most a quarter.
    void arc_to(Vector2d radii, double turn, bool large, bool clockwise, const Vector2d& end) {
        const Vector2d start = here_;
        if ((end - start).norm() <= 0) return;
        if (radii.minCoeff() <= 0) return line_to(end);
        Eigen::Matrix2d axes;
        axes << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
        Vector2d half = (axes.transpose() * (start - end) / 2).cwiseQuotient(radii);
        if (half.norm() > 1) {
            radii *= half.norm();
            half.normalize();
        }
        // On the unit circle: its middle lies across the chord.
        const double away = std::sqrt(std::max(0.0, 1 / half.squaredNorm() - 1)) * (large == clockwise ? -1 : 1);
        const Vector2d middle = away * Vector2d(half.y(), -half.x());
        const Vector2d from = half - middle, to = -half - middle;
        double sweep = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
        if (clockwise && sweep < 0) sweep += 2 * std::numbers::pi;
        if (!clockwise && sweep > 0) sweep -= 2 * std::numbers::pi;
        const Vector2d center = (start + end) / 2 + axes * middle.cwiseProduct(radii);
        const auto place = [&](const Vector2d& on_circle) -> Vector2d {
            return center + axes * on_circle.cwiseProduct(radii);
        };
        const int quarters = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / (std::numbers::pi / 2) - 1e-9)));
        const double step = sweep / quarters, reach = 4.0 / 3 * std::tan(step / 4);
        for (int i = 0; i < quarters; ++i) {
            const double angle = std::atan2(from.y(), from.x()) + step * i;
            const Vector2d a(std::cos(angle), std::sin(angle)), b(std::cos(angle + step), std::sin(angle + step));
            curve_to(place(a + reach * Vector2d(-a.y(), a.x())), place(b - reach * Vector2d(-b.y(), b.x())),
                     i + 1 == quarters ? end : place(b));
        }
    }

    PathText text_;
    double tolerance_;
    std::vector<Polyline> lines_;
    Vector2d here_ = Vector2d::Zero(), begin_ = Vector2d::Zero();
    Vector2d cubic_control_ = Vector2d::Zero(), quadratic_control_ = Vector2d::Zero();
};

}  // namespace

std::vector<Polyline> flattened_path(std::string_view data, double tolerance) {
    return PathFollower(data, tolerance).lines();
}

std::vector<double> svg_numbers(std::string_view text) {
    PathText numbers(text);
    std::vector<double> out;
    while (!numbers.ended()) out.push_back(numbers.number());
    return out;
}

}  // namespace exemplar
