// A table with what is known of loops besides their records: a line for each tag.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/contract/check/check_request.h"
#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// The facts about one loop.
struct KnownLoop {
    std::string tag;                ///< as written
    Json members = Json::object();  ///< as members of a CheckLoop
    LoopFacts facts;                ///< the same
};

class KnownLoops {
public:
    KnownLoops() = default;

    /// Reads a CSV with the column tag and any of kind, averaging, pv_low, pv_high, op_low, op_high, weight and
    /// today's settings (Kp, Ti, Td, Tf, b, c or Kp, Ki, Kd; form); a blank cell says nothing. Ti, Td and Tf are in
    /// `time_unit` or in the unit of their heading. 422 with a fault for each cell that is not valid, by line and
    /// column, for an unknown column and for a tag that occurs twice.
    static std::variant<KnownLoops, Problem> read(std::string_view bytes, const std::string& time_unit);

    /// The facts about the loop with this tag, whatever the case of its letters; null if the table has none.
    const KnownLoop* of(const std::string& tag);
    /// A sentence that names the tags that of() was not asked for; "" if there are none.
    std::string unused_note() const;

private:
    struct Entry {
        KnownLoop loop;
        bool used = false;
    };

    std::map<std::string, std::size_t> places_;  ///< in entries_, by tag in lower case
    std::vector<Entry> entries_;                 ///< in the order of the lines
};

}  // namespace tunewright::api
