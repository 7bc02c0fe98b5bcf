// Builds a program from other programs and from small dynamic parts: a controller within a cascade, a lead-lag, a dead
// time. The parts begin, in the first call and after a restart, as if their inputs had been constant before.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/code/program.h"

namespace tunewright::code {

constexpr int kMaxDelayCalls = 10'000;  ///< of a dead time: each call is a number in the program's memory

/// x becomes Phi x + Gamma v from call to call, with the output C x + D v.
struct DiscreteSystem {
    std::vector<double> Phi, Gamma;  ///< n x n, row by row; n
    std::vector<double> C;
    double D = 0;
    std::vector<double> Gamma_late = {};  ///< of an older v, which it adds; empty: none
};

class Composer {
public:
    Composer() = default;
    Composer(std::string name, std::string title);
    /// With the settings `Ts`, `at_rest` and `restart`, which all embedded programs share.
    Composer(std::string name, std::string title, double Ts);

    /// A variable that has been declared.
    Expr operator[](const std::string& name) const;
    Expr input(const std::string& name, const char* comment, Type type = Type::real) {
        return declare(VariableRole::input, name, comment, type);
    }
    /// An input that a call may leave out; it is then `otherwise`.
    Expr optional_input(const std::string& name, const char* comment, Type type, double otherwise = 0);
    Expr output(const std::string& name, const char* comment, Type type = Type::real) {
        return declare(VariableRole::output, name, comment, type);
    }
    Expr setting(const std::string& name, double value, const char* comment, Type type = Type::real);
    Expr state(const std::string& name, const char* comment, Type type = Type::real, int length = 0) {
        return declare(VariableRole::state, name, comment, type, length);
    }
    Expr local(const std::string& name, const char* comment, Type type = Type::real) {
        return declare(VariableRole::local, name, comment, type);
    }
    /// A local that is assigned here.
    Expr let(const std::string& name, const char* comment, const Expr& value);

    void add(Statement statement) { program_.body.push_back(std::move(statement)); }
    void add(Block block) { program_.body += std::move(block); }
    void add_bounded(const Expr& x, const Expr& value, const Expr& low, const Expr& high);
    /// In the first call, and after a restart, before everything else.
    void begin_with(Statement statement) { begin_.push_back(std::move(statement)); }

    /// Adds a program's statements. Its variables come between `prefix` and `suffix`; those in `names` have the name
    /// there. A variable of the whole with this name takes the place of an input, an output or a setting, and of any
    /// variable in `names`. Other outputs become local. The settings of all programs are shared.
    void embed(const Program& part, const std::map<std::string, std::string>& names, const std::string& prefix = "",
               const std::string& suffix = "");

    /// K (T_lead s + 1)/(T_lag s + 1) by backward Euler; T_lag may be 0. `before`: x until the first call.
    Expr lead_lag(const std::string& name, const Expr& x, const Expr& before, const Expr& K, const Expr& lead,
                  const Expr& lag);
    /// x some calls ago, linear between two calls.
    Expr delayed(const std::string& name, const Expr& x, const Expr& before, double calls);
    /// The output of a linear system that is at rest at 0 at first.
    Expr system(const std::string& name, const DiscreteSystem& system, const Expr& v);
    /// Its states of the next call.
    void move(const std::string& name, const DiscreteSystem& system, const Expr& v, const Expr& late = 0);

    Program take(std::vector<std::string> notes);

private:
    Expr declare(VariableRole role, const std::string& name, const char* comment, Type type = Type::real,
                 int length = 0) {
        return program_.declare({.role = role, .type = type, .name = name, .comment = comment, .length = length});
    }

    Program program_;
    Block begin_;
};

}  // namespace tunewright::code
