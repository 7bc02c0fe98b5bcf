// Builds a program from other programs and from small dynamic parts: a controller within a cascade, a lead-lag, a dead
// time.
//
// An embedded program keeps its law: its variables get other names, its inputs and settings may be bound to expressions
// of the whole, its outputs become local. The parts begin in a first call, or after a restart, as if what they read had
// been constant before.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

constexpr int kMaxDelayCalls = 10'000;  ///< of a dead time: each call is a number in the program's memory

/// How a program is embedded.
struct Embedding {
    /// The name of each variable in the whole. An output or a setting of the whole with this name takes its place.
    std::function<std::string(const std::string&)> renamed;
    std::map<std::string, Expr> bound;  ///< inputs and settings that are expressions of the whole
};

/// An embedded program: its statements, which the caller places, and its variables by the names that they had.
struct Embedded {
    std::map<std::string, Expr> variables;
    Block body;

    const Expr& operator[](const std::string& name) const { return variables.at(name); }
};

/// A linear system with one input that is held from call to call: x becomes Phi x + Gamma v.
struct DiscreteSystem {
    std::vector<double> Phi, Gamma;  ///< n x n, row by row; n
    std::vector<double> C;           ///< n
    double D = 0;
};

class Composer {
public:
    Composer(std::string name, std::string title) {
        program_.name = std::move(name);
        program_.title = std::move(title);
    }

    Expr input(const std::string& name, const char* comment);
    /// An input that a call may leave out.
    Expr optional_input(const std::string& name, const char* comment, Type type, double otherwise = 0);
    Expr output(const std::string& name, const char* comment);
    Expr setting(const std::string& name, double value, const char* comment, Type type = Type::real);
    /// The setting `name` of a program that will be embedded, under another name; with its own comment if none is
    /// given.
    Expr setting_of(const Program& part, const std::string& name, const std::string& renamed,
                    const char* comment = nullptr);
    Expr state(const std::string& name, const char* comment, Type type = Type::real, int length = 0);
    Expr local(const std::string& name, const char* comment, Type type = Type::real);

    void add(Statement statement) { program_.body.push_back(std::move(statement)); }
    void add(const Block& block) { program_.body.insert(program_.body.end(), block.begin(), block.end()); }
    /// In the first call, and after a restart, before everything else.
    void begin_with(Statement statement) { begin_.push_back(std::move(statement)); }

    Embedded embed(const Program& part, const Embedding& how);

    /// K (Tz s + 1)/(Tp s + 1) by backward Euler; Tp may be 0. `before`: the input until the first call. Returns a
    /// local `name`.
    Expr lead_lag(const std::string& name, const Expr& x, const Expr& before, const Expr& K, const Expr& Tz,
                  const Expr& Tp, const Expr& Ts);
    /// x `calls` calls ago, linear between calls. `before` as above.
    Expr delayed(const std::string& name, const Expr& x, const Expr& before, double calls);
    /// The output of a system whose states are 0 at first: C x + D v with the `v` of this call; then x moves by what
    /// was held. `v` may be assigned later in the call: move() then comes after that.
    Expr system_output(const std::string& name, const DiscreteSystem& system, const Expr& v);
    /// Phi x + Gamma v of the same system; `late`, where Gamma1 is not empty, is an input of its own with that effect.
    void move_system(const std::string& name, const DiscreteSystem& system, const Expr& v,
                     const std::vector<double>& Gamma1 = {}, const Expr& late = 0);

    /// The whole program. `restart`: the setting that begins again.
    Program take(const Expr& restart, std::vector<std::string> notes);

private:
    Expr declare(VariableRole role, const std::string& name, const char* comment, Type type, int length = 0) {
        return program_.declare({.role = role, .type = type, .name = name, .comment = comment, .length = length});
    }

    Program program_;
    Block begin_;
};

}  // namespace tunewright::code
