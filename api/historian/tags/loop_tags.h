// The loops in the tags or headings of a file: "FIC101.PV", "TIC-101/PID1/OUT.CV" and "TIC101.MODE.ACTUAL", in any
// order.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/heading.h"
#include "engine/check/loop_check.h"

namespace tunewright::api {

/// A tag as the name of a loop and the part of the loop that it holds.
struct TagName {
    std::optional<ColumnRole> role;  ///< y, u, r or mode; empty for another quantity, such as an alarm
    bool quality = false;            ///< the quality of the value with this role, not the value
    std::string loop;                ///< as written: "FIC101"; "" if the tag names only the part
    std::string key;                 ///< the same for each tag of a loop
    int order = 0;                   ///< rank among tags with the same role in one loop; the lowest is used
};

/// Splits one tag, with or without a unit behind it: the part is at the end ("FIC101.PV", "FIC-101_PV", "FIC101PV",
/// "FIC101/PV.CV", "FIC101.PV.Quality") or at the front ("PV_FIC101"), in the words of the headings of a record.
TagName split_tag(std::string_view tag);

/// What the loop of a tag measures, by the letters of ISA 5.1: "TIC-101", "2111FIC41004", "U7.LC3". The name is that of
/// the contract, "" for an unknown kind.
struct TagKind {
    check::LoopKind kind = check::LoopKind::unknown;
    std::string_view name;
};
TagKind kind_of_tag(std::string_view tag);

/// The tags of one loop, as indices.
struct LoopTags {
    std::string name;                                       ///< of the loop, as written
    std::array<std::optional<std::size_t>, kRoleCount> at;  ///< by role; there is no time
    std::optional<std::size_t> y_quality, u_quality;
    std::string fault = {};  ///< the reason why the tags are ambiguous; "" if they are not
};

struct GroupedTags {
    std::vector<LoopTags> loops;       ///< those with y and u, in the order of their first tags
    std::vector<std::string> partial;  ///< names of groups that have only one of y and u
};

GroupedTags group_tags(const std::vector<std::string>& tags);

/// The sentence that names groups without y or u; "" if there are none.
std::string partial_note(const std::vector<std::string>& partial);

}  // namespace tunewright::api
