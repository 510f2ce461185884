// exemplar hatch features: the types of features that styles depend on (thesis Figs. 4.15, 4.16).

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "host/hatching/style/selected_features.h"
#include "host/imaging/svg.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct FeaturesArguments {
    std::vector<fs::path> styles;
    fs::path out;
    CommonOptions common;
};

struct TypeShare {
    std::string type;
    double share;
};

/// The largest share first.
std::vector<TypeShare> ordered(const std::map<std::string, double>& shares) {
    std::vector<TypeShare> order;
    order.reserve(shares.size());
    for (const auto& [type, share] : shares) order.push_back({type, share});
    std::ranges::stable_sort(order, std::greater{}, &TypeShare::share);
    return order;
}

/// A bar chart for each use, one below the other.
class Chart {
  public:
    explicit Chart(std::size_t rows)
        : document_(k_width, k_row * static_cast<int>(rows) + 2 * k_row, "Features of hatching styles") {}

    void add_title(const std::string& text) {
        row_ += 0.5;
        add_text(8, text, "bold");
        row_ += 1;
    }
    void add_bar(const TypeShare& bar) {
        add_text(20, fmt::format("{} {:.0f}%", bar.type, 100 * bar.share), "normal");
        const std::array<SvgAttribute, 5> attributes{{{"x", svg_number(k_bars)},
                                                      {"y", svg_number(k_row * row_ + 3)},
                                                      {"width", svg_number((k_width - k_bars - 10) * bar.share)},
                                                      {"height", svg_number(k_row - 6)},
                                                      {"fill", "#4477aa"}}};
        document_.add("rect", attributes);
        row_ += 1;
    }
    const SvgDocument& document() const { return document_; }

  private:
    static constexpr int k_width = 620, k_row = 18, k_bars = 290;

    void add_text(double x, const std::string& text, const char* weight) {
        const std::array<SvgAttribute, 5> attributes{{{"x", svg_number(x)},
                                                      {"y", svg_number(k_row * (row_ + 0.75))},
                                                      {"font-family", "sans-serif"},
                                                      {"font-size", "12"},
                                                      {"font-weight", weight}}};
        document_.add_text(text, attributes);
    }

    SvgDocument document_;
    double row_ = 0;
};

void run_hatch_features(const FeaturesArguments& arguments) {
    std::vector<HatchingStyle> styles;
    for (const fs::path& path : arguments.styles) {
        require_input(path);
        styles.push_back(load_hatching_style(path));
    }
    if (!arguments.out.empty()) require_output_file(arguments.out);
    std::vector<std::pair<const char*, std::vector<TypeShare>>> uses;
    std::size_t rows = 0;
    nlohmann::json report;
    for (std::size_t k = 0; k < k_feature_uses; ++k) {
        const auto use = static_cast<FeatureUse>(k);
        const std::map<std::string, double> shares = selected_features(styles, use);
        if (shares.empty()) continue;
        uses.emplace_back(name_of(use), ordered(shares));
        rows += shares.size() + 2;
        report[name_of(use)] = shares;
    }
    Chart chart(rows);
    for (const auto& [use, order] : uses) {
        chart.add_title(use);
        if (!arguments.common.quiet) fmt::print("{}\n", use);
        for (const TypeShare& each : order) {
            chart.add_bar(each);
            if (!arguments.common.quiet) fmt::print("  {:3.0f} %  {}\n", 100 * each.share, each.type);
        }
    }
    if (!arguments.out.empty()) write_svg(arguments.out, chart.document());
    write_report(arguments.common, report);
}

}  // namespace

void add_hatch_features_command(Command& hatch) {
    auto arguments = std::make_shared<FeaturesArguments>();
    Command* command = hatch.add_subcommand(
        "features", "Tells which types of features styles depend on: how often each is among the first three selected");
    command->footer("Example:\n  exemplar hatch features first.safetensors second.safetensors --out features.svg");
    command->add_option("STYLE", arguments->styles, "style files of 'exemplar hatch train'")->required()->type_name("");
    command->add_option("--out", arguments->out, "draws them as bars into this SVG file")->type_name("FILE");
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_hatch_features(*arguments); });
}

}  // namespace exemplar
