// JSON Schemas of tools' arguments, made from the descriptions of the contract, short enough for an agent's context.
#pragma once

#include <set>
#include <string>

#include "api/describe/codec.h"
#include "api/json/json.h"

namespace tunewright::api::mcp {

/// The titles of the types that are shown so far.
using ShownTypes = std::set<std::string>;

/// A self-contained schema of a described type. The schemas of the document would fill a context, so that
///
/// - members that only answers have, lengths, titles, examples and marks of the document are left out;
/// - of several alternatives the first is shown in full, the others by their words and members in a sentence;
/// - of the members of an object only the main ones are shown where the description marks them, the others by name;
/// - a description is its first sentence, if that is short, and the unit;
/// - objects deeper than two levels, and those that an earlier tool shows, are shown by the names of their members.
///
/// Nothing that is left out is lost: a wrong argument is refused with the name, the rule and the cure.
Json tool_schema(const SchemaOf& describe, ShownTypes& shown);

/// The schema of one object with the members of both.
Json both(Json first, const Json& second);

}  // namespace tunewright::api::mcp
