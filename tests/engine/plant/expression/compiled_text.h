// A text compiled for the tests: variables x and u.
#pragma once

#include <string>

#include "engine/plant/expression/parser.h"
#include "engine/plant/expression/program_builder.h"
#include "engine/plant/expression/program_run.h"

namespace tunewright {

/// The program of one output, or the error's message.
inline std::variant<Program, std::string> compiled(const std::string& text) {
    const auto tree = parse_expression(text);
    if (!tree) return tree.error().message;
    ProgramBuilder builder({"x", "u"});
    const auto error = builder.add_output(*tree, "text", [](const std::string& name) -> NameMeaning {
        if (name == "x") return VariableIndex{0};
        if (name == "u") return VariableIndex{1};
        if (name == "a") return 2.0;
        return UnknownName{name + " is unknown"};
    });
    if (error) return error->message;
    return builder.finish();
}

template <class T>
T value_of(const std::string& text, const T& x, const T& u) {
    const T variables[] = {x, u};
    T result;
    std::get<Program>(compiled(text)).evaluate<T>(variables, std::span(&result, 1));
    return result;
}

/// The error's message; empty if the text compiles.
inline std::string complaint(const std::string& text) {
    const auto result = compiled(text);
    return result.index() == 1 ? std::get<1>(result) : "";
}

}  // namespace tunewright
