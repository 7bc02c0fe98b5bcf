#include "engine/plant/typed/plant_snippets.h"

#include <algorithm>
#include <variant>

#include "engine/number_text.h"
#include "engine/plant/typed/formula.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

/// Brackets, separators and names of one language.
struct Language {
    std::string_view name;
    std::string_view head;                                ///< lines before the plant
    std::string_view separator;                           ///< of the numbers of a list
    std::string_view row_open, row_separator, row_close;  ///< of the rows of a matrix
    std::string_view imaginary;                           ///< behind an imaginary part
    std::string_view prefix;                              ///< before the name of a function
    std::string_view comment;
};

constexpr Language kMatlab{"MATLAB", "", " ", "[", "; ", "]", "i", "", "%"};
constexpr Language kPython{
    "Python, python-control", "import control as ct\n\n", ", ", "[[", "], [", "]]", "j", "ct.", "#"};
constexpr Language kJulia{"Julia, ControlSystems.jl", "using ControlSystems\n\n", ", ", "[", "; ", "]", "im", "", "#"};

template <class Row, class Write>
std::string joined(const Row& row, std::string_view separator, const Write& write) {
    std::string out;
    for (const auto& x : row) {
        if (!out.empty()) out += separator;
        out += write(x);
    }
    return out;
}

std::string numbers(const std::vector<double>& row, std::string_view separator) {
    return joined(row, separator, exact_text);
}

/// The calls of a plant without its dead time.
class Calls {
public:
    explicit Calls(const Language& language) : language_(language) {}

    std::string operator()(const Fopdt& p) const { return tf({p.K}, lag(p.T)); }
    std::string operator()(const Sopdt& p) const {
        const std::string first = tf({p.K}, lag(p.T1));
        return p.T2 == 0 ? first : first + "*" + tf({1}, lag(p.T2));
    }
    std::string operator()(const OscillatorySopdt& p) const { return tf({p.K}, {p.T * p.T, 2 * p.zeta * p.T, 1}); }
    std::string operator()(const Ipdt& p) const {
        return p.T == 0 ? tf({p.K}, {1, 0}) : tf({p.K}, {1, 0}) + "*" + tf({1}, lag(p.T));
    }
    std::string operator()(const TransferFunction& p) const { return tf(p.num, p.den); }
    std::string operator()(const Zpk& p) const {
        return call("zpk") + roots(p.zeros) + ", " + roots(p.poles) + ", " + exact_text(p.K) + ")";
    }
    std::string operator()(const StateSpace& p) const {
        std::vector<std::vector<double>> B;
        for (const double x : p.B) B.push_back({x});
        return call("ss") + matrix(p.A) + ", " + matrix(B) + ", " + matrix({p.C}) + ", " + matrix({{p.D}}) + ")";
    }

private:
    static std::vector<double> lag(double T) { return T == 0 ? std::vector<double>{1} : std::vector<double>{T, 1}; }

    std::string call(std::string_view function) const {
        return std::string(language_.prefix) + std::string(function) + "(";
    }
    std::string tf(const std::vector<double>& num, const std::vector<double>& den) const {
        return call("tf") + "[" + numbers(num, language_.separator) + "], [" + numbers(den, language_.separator) + "])";
    }
    std::string roots(const std::vector<Complex>& roots) const {
        const auto root = [&](Complex r) {
            const std::string sign = r.imag() < 0 ? "" : "+";
            return exact_text(r.real()) +
                   (r.imag() == 0 ? "" : sign + exact_text(r.imag()) + std::string(language_.imaginary));
        };
        // An empty list of Julia has no type.
        if (roots.empty() && language_.imaginary == "im") return "Float64[]";
        return "[" + joined(roots, language_.separator, root) + "]";
    }
    std::string matrix(const std::vector<std::vector<double>>& rows) const {
        const bool commas = language_.row_open == "[[";
        return std::string(language_.row_open) +
               joined(rows, language_.row_separator,
                      [&](const auto& row) { return numbers(row, commas ? ", " : " "); }) +
               std::string(language_.row_close);
    }

    const Language& language_;
};

/// A label is free text: one with a line break would end the comment.
std::string first_line(std::string_view comment, std::string_view unit) {
    const bool printable = std::ranges::none_of(unit, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    if (unit == "s" || unit.empty() || !printable) return "";
    return std::string(comment) + " times in " + std::string(unit) + "\n";
}

std::string matlab(const Plant& plant, double L, std::string_view unit) {
    std::string text = std::visit(Calls(kMatlab), plant);
    if (L != 0) text.insert(text.size() - 1, ", 'InputDelay', " + exact_text(L));
    return first_line(kMatlab.comment, unit) + "P = " + text + ";";
}

std::string python(const Plant& plant, double L, std::string_view unit) {
    std::string text = first_line(kPython.comment, unit) + std::string(kPython.head);
    if (L == 0) return text + "P = " + std::visit(Calls(kPython), plant);
    const std::string order = std::to_string(kPadeOrder);
    return text + "# python-control has no dead time; this is a Pade approximation of order " + order +
           ".\nP = " + std::visit(Calls(kPython), plant) + "*ct.tf(*ct.pade(" + exact_text(L) + ", " + order + "))";
}

std::string julia(const Plant& plant, double L, std::string_view unit) {
    return first_line(kJulia.comment, unit) + std::string(kJulia.head) + "P = " + std::visit(Calls(kJulia), plant) +
           (L == 0 ? "" : "*delay(" + exact_text(L) + ")");
}

std::string block(std::string_view kind, std::string_view name, const std::string& arguments) {
    return "Modelica.Blocks." + std::string(kind) + " " + std::string(name) + "(" + arguments + ");";
}

std::string transfer_block(std::string_view name, const std::vector<double>& num, const std::vector<double>& den) {
    return block("Continuous.TransferFunction", name, "b={" + numbers(num, ", ") + "}, a={" + numbers(den, ", ") + "}");
}

struct ModelicaBlocks {
    std::vector<std::string> operator()(const Fopdt& p) const { return {lag("process", p.K, p.T)}; }
    std::vector<std::string> operator()(const Sopdt& p) const {
        if (p.T2 == 0) return {lag("process", p.K, p.T1)};
        return {lag("process", p.K, p.T1), lag("second", 1, p.T2)};
    }
    std::vector<std::string> operator()(const OscillatorySopdt& p) const {
        return {transfer_block("process", {p.K}, {p.T * p.T, 2 * p.zeta * p.T, 1})};
    }
    std::vector<std::string> operator()(const Ipdt& p) const {
        const std::string integrator = block("Continuous.Integrator", "process", "k=" + exact_text(p.K));
        if (p.T == 0) return {integrator};
        return {integrator, lag("second", 1, p.T)};
    }
    std::vector<std::string> operator()(const TransferFunction& p) const {
        return {transfer_block("process", p.num, p.den)};
    }
    std::vector<std::string> operator()(const Zpk& p) const {
        typed::Formula formula = *typed::formula_of(p);
        typed::Polynomial num = typed::expanded(formula.num);
        for (double& c : num) c *= formula.gain;
        return {transfer_block("process", num, typed::expanded(formula.den))};
    }
    std::vector<std::string> operator()(const StateSpace& p) const {
        const auto row = [](const std::vector<double>& x) { return numbers(x, ", "); };
        return {block("Continuous.StateSpace", "process",
                      "A=[" + joined(p.A, "; ", row) + "], B=[" + numbers(p.B, "; ") + "], C=[" + row(p.C) + "], D=[" +
                          exact_text(p.D) + "]")};
    }

private:
    static std::string lag(std::string_view name, double K, double T) {
        if (T == 0) return block("Math.Gain", name, "k=" + exact_text(K));
        return block("Continuous.FirstOrder", name, "k=" + exact_text(K) + ", T=" + exact_text(T));
    }
};

std::string modelica(const Plant& plant, double L, std::string_view unit) {
    std::vector<std::string> blocks = std::visit(ModelicaBlocks(), plant);
    const bool second = blocks.size() > 1;
    if (L != 0) blocks.push_back(block("Nonlinear.FixedDelay", "dead_time", "delayTime=" + exact_text(L)));
    std::string text = first_line("//", unit) + joined(blocks, "\n", [](const std::string& line) { return line; });
    if (blocks.size() > 1) text += "\nequation";
    if (L != 0) text += "\n  connect(dead_time.y, process.u);";
    if (second) text += "\n  connect(process.y, second.u);";
    return text;
}

}  // namespace

std::vector<PlantSnippet> plant_snippets(const Plant& plant, std::string_view time_unit) {
    const double L = dead_time(plant);
    return {{kMatlab.name, matlab(plant, L, time_unit)},
            {kPython.name, python(plant, L, time_unit)},
            {kJulia.name, julia(plant, L, time_unit)},
            {"Modelica", modelica(plant, L, time_unit)}};
}

}  // namespace tunewright
