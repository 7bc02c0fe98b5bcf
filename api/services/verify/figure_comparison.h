// Figures of an answer and of the second computation, written with the same description and compared member by member.
#pragma once

#include <string>

#include "api/contract/result/verify_call.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/evaluation/evaluation.h"

namespace tunewright::api {

/// The value as JSON, as its description writes it.
template <class T>
Json json_of(const Description<T>& description, const T& value) {
    Writer out;
    description.write(value, out);
    return Json::parse(out.view());
}

/// Compares one value; `figure` names its tolerance (verify::largest_difference), `stated` has those of the indices.
void compare_value(VerifyAnswer& answer, const std::string& where, std::string_view figure, const Json& given,
                   const Json& found, const IndexErrors& stated);

/// Compares every number, boolean and null below `given` with the same member of `found`; texts are left out, and
/// members that have no tolerance.
void compare_figures(VerifyAnswer& answer, const std::string& where, const Json& given, const Json& found,
                     const IndexErrors& stated);

}  // namespace tunewright::api
