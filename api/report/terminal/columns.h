// Tables for a terminal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunewright::api {

/// Number of letters in UTF-8 text, whatever their number of bytes.
inline std::size_t letters(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Columns as wide as their widest cell; the first `left` of them are aligned left, the others are numbers, aligned
/// right.
class Columns {
public:
    Columns(std::vector<std::string> heads, std::size_t left) : left_(left) { row(std::move(heads)); }

    void row(std::vector<std::string> cells) {
        widths_.resize(std::max(widths_.size(), cells.size()), 0);
        for (std::size_t i = 0; i < cells.size(); ++i) widths_[i] = std::max(widths_[i], letters(cells[i]));
        rows_.push_back(std::move(cells));
    }

    std::string text() const {
        std::string out;
        for (const auto& cells : rows_) {
            std::string line;
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const std::string room(widths_[i] - letters(cells[i]), ' ');
                line += (i == 0 ? "" : "  ") + (i < left_ ? cells[i] + room : room + cells[i]);
            }
            out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
        }
        return out;
    }

private:
    std::size_t left_;
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> widths_;
};

}  // namespace tunewright::api
