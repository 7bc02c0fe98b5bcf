// The elements of Presentation MathML for the formulas of plants and methods. The content is MathML already: the caller
// has escaped &, < and >.
#pragma once

#include <string>

namespace tunewright::api::mathml_elements {

inline std::string element(const char* tag, const std::string& inside) {
    return std::string("<") + tag + ">" + inside + "</" + tag + ">";
}

inline std::string mo(const char* sign) { return element("mo", sign); }
inline std::string mi(const std::string& name) { return element("mi", name); }
inline std::string row(const std::string& inside) { return element("mrow", inside); }
inline std::string brackets(const std::string& inside) { return row(mo("(") + inside + mo(")")); }

inline std::string fraction(const std::string& top, const std::string& bottom) {
    return element("mfrac", row(top) + row(bottom));
}

inline std::string power(const std::string& base, const std::string& exponent) {
    return element("msup", base + exponent);
}

/// A formula on a line of its own.
inline std::string math(const std::string& inside) {
    return "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\">" + inside + "</math>";
}

}  // namespace tunewright::api::mathml_elements
