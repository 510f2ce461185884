#include "apps/viewer/window/paint_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <map>
#include <sstream>
#include <thread>

#include "apps/viewer/painting/paint_gesture.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/core/text.h"
#include "host/imaging/png.h"
#include "host/labeling/painting/painting_file.h"
#include "host/mesh/color_text.h"

namespace exemplar {
namespace {

const std::map<std::string, ViewSide> k_script_sides{{"back", ViewSide::back},   {"bottom", ViewSide::bottom},
                                                     {"front", ViewSide::front}, {"left", ViewSide::left},
                                                     {"right", ViewSide::right}, {"top", ViewSide::top}};

using Words = std::vector<std::string>;

/// Returns the words of a line; one in quotes may have spaces.
Words words_of(const std::string& line) {
    std::istringstream in(line);
    Words words;
    for (std::string word; in >> std::quoted(word);) words.push_back(word);
    return words;
}

/// Runs the commands of a script, one after the other.
class PaintScript {
  public:
    PaintScript(ViewerState& state, FrameRenderer& renderer, ViewSize size)
        : state_(state), renderer_(renderer), size_(size) {}

    /// Runs one line. Throws UsageError if it is not understood.
    void run(const std::string& line);

  private:
    float number(const std::string& word) const;
    void need(const Words& words, std::size_t least, const char* form) const;
    void gesture(PaintTool tool, const Words& words);
    void choose_label(const Words& words);
    void set_radius(const Words& words);
    void rename(const Words& words);
    void switch_setting(const Words& words);
    void paint(const Words& words);
    void edit(const Words& words);
    void turn(const Words& words);
    void look_from(const Words& words);
    void show_uncertain(const Words& words);
    void verify(const Words& words);
    void next(const Words& words);
    void accept(const Words& words);
    void learn(const Words& words);
    void print_state(const Words& words);
    void wait(const Words& words);
    void open(const Words& words);
    void picture(const Words& words);
    LabelingSession& session() { return *state_.labeling; }

    ViewerState& state_;
    FrameRenderer& renderer_;
    ViewSize size_;
};

float PaintScript::number(const std::string& word) const {
    std::istringstream in(word);
    float value = 0;
    if (!(in >> value) || !in.eof()) throw UsageError(fmt::format("'{}' is no number", word.substr(0, 40)));
    return value;
}

void PaintScript::need(const Words& words, std::size_t least, const char* form) const {
    if (words.size() < least) throw UsageError(fmt::format("write it as: {}", form));
}

void PaintScript::gesture(PaintTool tool, const Words& words) {
    if (words.size() < 3 || words.size() % 2 == 0) throw UsageError("places are pairs of pixels: X Y X Y ...");
    const PaintTool before = std::exchange(session().settings.tool, tool);
    const FacePicture& faces = renderer_.face_picture(state_, size_);
    PaintGesture gesture;
    for (std::size_t i = 1; i + 1 < words.size(); i += 2) {
        const Vec2 at(number(words[i]), number(words[i + 1]));
        i == 1 ? gesture.press(session(), faces, at) : gesture.drag(session(), faces, at);
    }
    gesture.release(session(), faces);
    session().settings.tool = before;
}

void PaintScript::choose_label(const Words& words) {
    need(words, 2, "label NAME [#rrggbb]");
    const auto place = std::ranges::find(session().palette(), words[1], &PaletteEntry::name);
    if (place == session().palette().end()) {
        session().add_label(words[1], words.size() > 2 ? color_of_hex(words[2]) : std::nullopt);
        return;
    }
    session().settings.label = static_cast<std::int32_t>(place - session().palette().begin());
    if (words.size() < 3) return;
    if (const auto color = color_of_hex(words[2]))
        session().recolor_label(static_cast<std::size_t>(session().settings.label), *color);
}

// Waits for completions, and if asked for, for features or for all work of the background.
void PaintScript::wait(const Words& words) {
    const std::string what = words.size() > 1 ? words[1] : "completion";
    const auto waits = [&] {
        if (what == "learning") return session().job() != nullptr || session().painter().busy();
        return session().painter().busy() || (what == "features" && !session().painter().has_features());
    };
    do {
        check_interrupt();
        state_.collect_labeling();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (waits());
    state_.collect_labeling();
    if (const double seconds = session().painter().completion_seconds(); seconds > 0)
        fmt::print("labels completed in {:.0f} ms\n", 1000 * seconds);
}

void PaintScript::open(const Words& words) {
    need(words, 2, "open NAME");
    const std::string& name = words[1];
    const auto& shapes = session().folder().shapes();
    const auto place = std::ranges::find_if(
        shapes, [&](const FolderShape& shape) { return shape.path.filename() == name || shape.path.stem() == name; });
    if (place == shapes.end())
        throw UsageError(fmt::format("there is no shape '{}' in the folder", name.substr(0, 40)));
    state_.open_shape(static_cast<std::size_t>(place - shapes.begin()), size_);
}

void PaintScript::picture(const Words& words) {
    need(words, 2, "picture FILE.png");
    state_.collect_labeling();
    renderer_.follow(state_);
    renderer_.record(state_, size_);
    renderer_.stream().submit();
    renderer_.finish(state_.times);
    write_png(words[1], renderer_.read());
}

void PaintScript::set_radius(const Words& words) {
    need(words, 2, "radius PIXELS");
    session().settings.radius = std::clamp(number(words[1]), 0.5F, 500.0F);
}

void PaintScript::rename(const Words& words) {
    need(words, 2, "rename NAME");
    session().rename_label(static_cast<std::size_t>(session().settings.label), words[1]);
}

void PaintScript::switch_setting(const Words& words) {
    need(words, 2, "through|complete|confidence on|off");
    const bool on = words[1] != "off";
    PaintSettings& settings = session().settings;
    (words[0] == "through" ? settings.through : words[0] == "complete" ? settings.completes : settings.confidence) = on;
    ++session().settings_version;
}

void PaintScript::paint(const Words& words) {
    static const std::map<std::string, PaintTool> k_tools{{"stroke", PaintTool::brush},
                                                          {"erase", PaintTool::eraser},
                                                          {"lasso", PaintTool::lasso},
                                                          {"fill", PaintTool::fill}};
    gesture(k_tools.at(words[0]), words);
}

void PaintScript::edit(const Words& words) {
    LabelPainter& painter = session().painter();
    if (words[0] == "mirror")
        fmt::print("{} faces painted like their mirror images\n", painter.mirror());
    else if (words[0] == "anew")
        painter.discard_suggestion();
    else
        words[0] == "undo" ? painter.undo() : painter.redo();
    session().keep_strokes();
}

void PaintScript::turn(const Words& words) {
    constexpr float k_degree = 0.0174532925F;
    need(words, 3, "turn DEGREES_RIGHT DEGREES_DOWN");
    state_.camera.turn(k_degree * number(words[1]), k_degree * number(words[2]));
}

void PaintScript::look_from(const Words& words) {
    need(words, 2, "side front|back|left|right|top|bottom");
    const auto side = k_script_sides.find(words[1]);
    if (side == k_script_sides.end()) throw UsageError(fmt::format("there is no side '{}'", words[1].substr(0, 40)));
    state_.camera.look_from(side->second);
    state_.fit(size_);
}

void PaintScript::show_uncertain(const Words&) {
    state_.show_uncertain_place();
}

void PaintScript::verify(const Words&) {
    session().verify();
    fmt::print("{} verified\n", session().path().filename().string());
}

void PaintScript::next(const Words&) {
    const auto shape = session().next_shape();
    if (shape) state_.open_shape(*shape, size_);
    fmt::print("{}\n", shape ? session().path().filename().string() : "all shapes are verified");
}

void PaintScript::accept(const Words&) {
    const auto shapes = session().to_verify();
    if (shapes.empty()) throw UsageError("there is no suggested shape to accept");
    session().accept(shapes.front());
    fmt::print("{} accepted\n", session().folder().shapes()[shapes.front()].path.filename().string());
}

void PaintScript::learn(const Words&) {
    session().learn();
}

void PaintScript::print_state(const Words&) {
    static const std::map<ShapeState, const char*> k_states{{ShapeState::empty, "empty"},
                                                            {ShapeState::suggested, "suggested"},
                                                            {ShapeState::verified, "verified"},
                                                            {ShapeState::broken, "broken"}};
    const auto& shapes = session().folder().shapes();
    for (std::size_t s = 0; s < shapes.size(); ++s)
        fmt::print("{} {}\n", shapes[s].path.filename().string(), k_states.at(session().state_of(s)));
    const LabelPainter& painter = session().painter();
    fmt::print("{} of {} faces painted, {} without a label\n", painter.painted().painted_count(), painter.face_count(),
               painter.unlabeled_count());
}

void PaintScript::run(const std::string& line) {
    using Do = void (PaintScript::*)(const Words&);
    static const std::map<std::string, Do> k_commands{{"accept", &PaintScript::accept},
                                                      {"complete", &PaintScript::switch_setting},
                                                      {"confidence", &PaintScript::switch_setting},
                                                      {"erase", &PaintScript::paint},
                                                      {"fill", &PaintScript::paint},
                                                      {"label", &PaintScript::choose_label},
                                                      {"lasso", &PaintScript::paint},
                                                      {"learn", &PaintScript::learn},
                                                      {"anew", &PaintScript::edit},
                                                      {"mirror", &PaintScript::edit},
                                                      {"next", &PaintScript::next},
                                                      {"open", &PaintScript::open},
                                                      {"picture", &PaintScript::picture},
                                                      {"radius", &PaintScript::set_radius},
                                                      {"redo", &PaintScript::edit},
                                                      {"rename", &PaintScript::rename},
                                                      {"side", &PaintScript::look_from},
                                                      {"state", &PaintScript::print_state},
                                                      {"stroke", &PaintScript::paint},
                                                      {"through", &PaintScript::switch_setting},
                                                      {"turn", &PaintScript::turn},
                                                      {"uncertain", &PaintScript::show_uncertain},
                                                      {"undo", &PaintScript::edit},
                                                      {"verify", &PaintScript::verify},
                                                      {"wait", &PaintScript::wait}};
    const Words words = words_of(line);
    if (words.empty() || words[0].starts_with("#")) return;
    const auto command = k_commands.find(words[0]);
    if (command != k_commands.end()) return (this->*command->second)(words);
    std::vector<std::string> names;
    names.reserve(k_commands.size());
    for (const auto& entry : k_commands) names.push_back(entry.first);
    throw UsageError(fmt::format("there is no command '{}'{}", words[0].substr(0, 40), suggestion(words[0], names)));
}

}  // namespace

void run_paint_script(const std::filesystem::path& path, ViewerState& state, FrameRenderer& renderer,
                      const ViewerOptions& options) {
    std::istringstream lines(read_file(path));
    PaintScript script(state, renderer, options.size);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        check_interrupt();
        try {
            script.run(line);
        } catch (const UsageError& error) {
            throw UsageError(fmt::format("{}:{}: {}", path.string(), number, error.what()));
        }
    }
    state.collect_labeling();
    for (const Messages::Message& message : state.messages.all()) fmt::print(stderr, "remark: {}\n", message.text);
}

}  // namespace exemplar
