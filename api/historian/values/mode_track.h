// The mode of a loop in each row, in the words of its file.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/loop_mode.h"

namespace tunewright::api {

/// Reads a column or a tag of modes, which keep their value until the next one. Words stay as they are ("CAS", "OOS");
/// codes become AUTO and MAN if the heading gives their meaning. Without any meaning the mode stays unknown; a code
/// that the heading leaves out is "code 3".
class ModeTrack {
public:
    /// `tag` is the heading, which may give the meaning of codes: "Mode (0=MAN, 1=AUTO)".
    explicit ModeTrack(std::string_view tag) : codes_(mode_codes(split_heading(tag))) {}

    /// Takes a cell as the mode from now on; a mark of a missing value changes nothing.
    void see(std::string_view cell);
    /// The present mode, as an index in words(); 0: unknown.
    std::uint8_t now() const { return now_; }

    const std::vector<std::string>& words() const { return words_; }
    /// The first code without a meaning; "" if there is none.
    const std::string& unknown_code() const { return unknown_code_; }

private:
    std::uint8_t index_of(std::string_view cell);

    ModeCodes codes_;
    std::uint8_t now_ = 0;
    std::string last_cell_, unknown_code_;
    std::vector<std::string> words_ = {""};
};

}  // namespace tunewright::api
