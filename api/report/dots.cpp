// Responses as text: each letter of Braille has two by four dots.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "api/report/figures.h"
#include "api/report/plot.h"
#include "api/report/terminal.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr int kColumns = 62, kRows = 12;  // letters inside the frame
constexpr int kAcross = 2, kDown = 4;     // dots of a letter
constexpr std::size_t kMargin = 9;        // letters left of the frame

class Dots {
public:
    void set(int x, int y) {
        if (x < 0 || y < 0 || x >= kColumns * kAcross || y >= kRows * kDown) return;
        // Dots 1 to 8 of the letter, in the order of Unicode's bits.
        constexpr int kBits[kDown][kAcross] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
        cells_[static_cast<std::size_t>((y / kDown) * kColumns + x / kAcross)] |= kBits[y % kDown][x % kAcross];
    }

    void line(double x1, double y1, double x2, double y2) {
        const int steps = 1 + static_cast<int>(std::max(std::abs(x2 - x1), std::abs(y2 - y1)));
        for (int i = 0; i <= steps; ++i) {
            const double part = static_cast<double>(i) / steps;
            set(static_cast<int>(std::lround(x1 + part * (x2 - x1))),
                static_cast<int>(std::lround(y1 + part * (y2 - y1))));
        }
    }

    std::string row(int number) const {
        std::string out;
        for (int column = 0; column < kColumns; ++column) {
            const int code = 0x2800 + cells_[static_cast<std::size_t>(number * kColumns + column)];
            out += {static_cast<char>(0xE0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 0x3F)),
                    static_cast<char>(0x80 | (code & 0x3F))};
        }
        return out;
    }

private:
    std::vector<int> cells_ = std::vector<int>(static_cast<std::size_t>(kColumns * kRows), 0);
};

void draw(const Trace& trace, const Frame& frame, Dots& dots) {
    const double right = kColumns * kAcross - 1, bottom = kRows * kDown - 1;
    const auto across = [&](double x) { return (x - frame.x.first) / (frame.x.second - frame.x.first) * right; };
    const auto down = [&](double y) { return (frame.y.second - y) / (frame.y.second - frame.y.first) * bottom; };
    for (std::size_t i = 1; i < std::min(trace.x.size(), trace.y.size()); ++i) {
        const double values[] = {trace.x[i - 1], trace.y[i - 1], trace.x[i], trace.y[i]};
        if (std::all_of(std::begin(values), std::end(values), [](double v) { return std::isfinite(v); }))
            dots.line(across(values[0]), down(values[1]), across(values[2]), down(values[3]));
    }
}

std::string padded(const std::string& text) {
    return std::string(kMargin - std::min(kMargin, text.size()), ' ') + text;
}

std::string drawn_in_dots(const Plot& plot, const Frame& frame) {
    Dots dots;
    for (const Trace& trace : plot.traces) draw(trace, frame, dots);
    std::string out = std::string(kMargin + 1, ' ') + plot.title;
    if (plot.traces.size() > 1)
        for (std::size_t i = 0; i < plot.traces.size(); ++i) out += (i == 0 ? ": " : ", ") + plot.traces[i].name;
    out += "\n";
    for (int row = 0; row < kRows; ++row) {
        std::string mark;
        if (row == 0) mark = tunewright::text(frame.y.second, 3);
        if (row == kRows - 1) mark = tunewright::text(frame.y.first, 3);
        out += padded(mark) + "│" + dots.row(row) + "\n";
    }
    const std::string from = tunewright::text(frame.x.first, 3),
                      to = tunewright::text(frame.x.second, 4) + "  " + plot.x_label;
    const std::size_t room =
        static_cast<std::size_t>(kColumns) - std::min<std::size_t>(kColumns, from.size() + to.size());
    return out + std::string(kMargin, ' ') + "└" + from + std::string(room, ' ') + to + "\n";
}

std::variant<std::vector<Plot>, Problem> plots_of(const ResultSource& source, std::string_view index) try {
    auto chosen = choose_entry(source, index);
    if (auto* problem = std::get_if<Problem>(&chosen)) return std::move(*problem);
    auto& found = std::get<ChosenEntry>(chosen);
    const std::size_t number = index.empty() ? best_proposal(found) : found.index;
    const Json document = document_of(found);
    std::vector<Plot> plots = response_plots(subject_of(document, number));
    std::erase_if(plots, [](const Plot& plot) { return !frame_of(plot); });
    if (plots.empty())
        return Problem{422,
                       "no-traces",
                       "There is nothing to draw",
                       "The result has no traces: its request asked for none. Leave evaluate.points out of it.",
                       {},
                       {}};
    return plots;
} catch (const Json::exception&) {
    return not_a_result();
}

}  // namespace

std::variant<std::string, Problem> responses_text(const ResultSource& source, std::string_view index) {
    auto plots = plots_of(source, index);
    if (auto* problem = std::get_if<Problem>(&plots)) return std::move(*problem);
    std::string out;
    for (const Plot& plot : std::get<std::vector<Plot>>(plots)) out += drawn_in_dots(plot, *frame_of(plot)) + "\n";
    return out;
}

std::variant<std::string, Problem> responses_svg(const ResultSource& source, std::string_view index) {
    auto plots = plots_of(source, index);
    if (auto* problem = std::get_if<Problem>(&plots)) return std::move(*problem);
    return svg_file(std::get<std::vector<Plot>>(plots));
}

}  // namespace tunewright::api
