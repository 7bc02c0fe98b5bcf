#include "engine/plant/nonlinear/input_degree.h"

#include <algorithm>

namespace tunewright {
namespace {

// Abstract interpretation: the degree of every register.
class DegreeAnalysis {
public:
    explicit DegreeAnalysis(const Program& program)
        : program_(program),
          first_(program.registers() - static_cast<int>(program.instructions().size())),
          degrees_(static_cast<std::size_t>(program.registers()), InputDegree::absent) {
        degrees_[static_cast<std::size_t>(program.variables()) - 1] = InputDegree::affine;
        auto next = degrees_.begin() + first_;
        for (const Instruction& instruction : program.instructions()) *next++ = of(instruction);
    }

    InputDegree at(int where) const { return degrees_[static_cast<std::size_t>(where)]; }

    // The instruction that makes this register nonlinear.
    int culprit(int where) const {
        for (;;) {
            const Instruction& i = program_.instructions()[static_cast<std::size_t>(where - first_)];
            int next = -1;
            for (const int operand : {i.a, i.b, i.c})
                if (at(operand) == InputDegree::nonlinear) next = operand;
            if (next < 0) return where - first_;
            where = next;
        }
    }

private:
    bool is_zero(int where) const {
        const int index = where - program_.variables();
        return index >= 0 && where < first_ && program_.constants()[static_cast<std::size_t>(index)] == 0;
    }

    InputDegree of(const Instruction& i) const {
        const InputDegree a = at(i.a), b = at(i.b), c = at(i.c);
        const InputDegree any = std::max({a, b, c});
        switch (i.operation) {
            case Operation::add:
            case Operation::subtract:
            case Operation::negate: return any;
            case Operation::multiply:
                if (is_zero(i.a) || is_zero(i.b)) return InputDegree::absent;
                return a != InputDegree::absent && b != InputDegree::absent ? InputDegree::nonlinear : any;
            case Operation::divide: return b == InputDegree::absent ? a : InputDegree::nonlinear;
            case Operation::select: return a == InputDegree::absent ? std::max(b, c) : InputDegree::nonlinear;
            default: return any == InputDegree::absent ? any : InputDegree::nonlinear;
        }
    }

    const Program& program_;
    int first_;
    std::vector<InputDegree> degrees_;
};

}  // namespace

std::vector<InputDegree> input_degrees(const NonlinearSystem& system) {
    const DegreeAnalysis analysis(system.program());
    std::vector<InputDegree> result;
    result.reserve(static_cast<std::size_t>(system.order()));
    for (int i = 0; i < system.order(); ++i) result.push_back(analysis.at(system.program().output_register(i)));
    return result;
}

std::optional<Error> not_affine(const NonlinearSystem& system) {
    const Program& program = system.program();
    const DegreeAnalysis analysis(program);
    for (int i = 0; i < system.order(); ++i) {
        const int at = program.output_register(i);
        if (analysis.at(at) != InputDegree::nonlinear) continue;
        const std::string& state = system.description().states[static_cast<std::size_t>(i)].name;
        return Error{ErrorKind::unsupported, "plant/equations/" + state,
                     program.place(analysis.culprit(at)) + ": the input " + system.description().input.name +
                         " enters nonlinearly; this needs equations of the form f(x) + g(x) " +
                         system.description().input.name + ". An actuator state makes them so."};
    }
    return std::nullopt;
}

}  // namespace tunewright
