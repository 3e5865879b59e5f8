#include "variants/opencl/source.hpp"

#include "kernels/stage_row/element_pressure.hpp"
#include "variants/opencl/embedded.hpp"

#include <fmt/format.h>

namespace dss::opencl {
namespace {

constexpr std::string_view device_folder = "variants/opencl/device/";

/// The text of a file, with the text of all files that it includes.
std::string text_of(std::string_view path) {
  constexpr std::string_view include = "#include \"";
  std::string text(embedded(path));
  for (std::size_t at = text.find(include); at != std::string::npos; at = text.find(include)) {
    const std::size_t name = at + include.size(), quote = text.find('"', name);
    text.replace(at, quote + 1 - at, text_of(text.substr(name, quote - name)));
  }
  return text;
}
std::string device_text(std::string_view name) {
  return text_of(fmt::format("{}{}", device_folder, name));
}

std::string numbered(std::string_view format, int first, int last) {
  std::string list;
  for (int n = first; n <= last; ++n)
    list += fmt::format(fmt::runtime(format), n < 10 ? char('0' + n) : char('a' + n - 10));
  return list;
}

/// Defines a REAL of several lanes, and shifts of lanes to the next element.
std::string vector_words(const ProgramKind& kind) {
  const int w = kind.lanes;
  const char* const bits = kind.precision == Precision::f64 ? "long" : "int";
  std::string lane_bits;
  for (int n = 0; n < w; ++n) lane_bits += fmt::format("{}{}", n == 0 ? "" : ", ", 1 << n);
  const char last = numbered("{}", w - 1, w - 1).front();
  return fmt::format("#define REAL {0}{1}\n#define BITS {2}{1}\n#define LANE_BITS ((BITS)({3}))\n"
                     "#define SPLAT(a) ((REAL)((NUMBER)(a)))\n"
                     "#define SHIFT_UP(below, a) ((REAL)((below).s{4}{5}))\n"
                     "#define SHIFT_DOWN(a, above) ((REAL)({6}(above).s0))\n",
                     kind.precision == Precision::f64 ? "double" : "float", w, bits, lane_bits,
                     last, numbered(", (a).s{}", 0, w - 2), numbered("(a).s{}, ", 1, w - 1));
}

/// Defines the components of a tuple that the model has, between two fields of a full state.
std::string tuple_words(const ModelDescriptor& layout, std::string_view name, Field first,
                        Field last) {
  const std::string_view letters = last - first == 3 ? "sxyz" : "xyz";
  std::string components, each;
  for (const Field field : layout.fields)
    if (field >= first && field <= last) {
      components += fmt::format(" act({})", letters[std::size_t(field - first)]);
      each += fmt::format(" act(t.{})", letters[std::size_t(field - first)]);
    }
  return fmt::format("#define COMPONENTS_OF_{0}(act){1}\n#define EACH_OF_{0}(act, t){2}\n", name,
                     components, each);
}

std::string model_words(Model model) {
  const ModelDescriptor& layout = descriptor(model);
  return fmt::format("#define VEC_SIZE {}\n#define SPIN_SIZE {}\n#define FIELDS {}\n{}{}{}",
                     layout.vec_size(), layout.spin_size(), layout.fields.size(),
                     tuple_words(layout, "VEC", ux, uz), tuple_words(layout, "ROTOR", qs, qz),
                     tuple_words(layout, "SPIN", wx, wz));
}

/// Defines which parts of an element's pressure rows store.
std::string pressure_words(Model model, const Terms& terms) {
  const PressureParts parts = pressure_parts(model, terms);
  return fmt::format("#define HAS_PRESSURE {}\n#define IS_BENT {}\n#define PRESSURE_SIZE {}\n"
                     "#define COMPONENTS_OF_PRESSURE(act){}{}{}{}\n",
                     int(parts.count() > 0), int(parts.has_bending()), parts.count(),
                     parts.has_volume ? " act(s)" : "", parts.has_bending_x ? " act(x)" : "",
                     parts.has_bending_y ? " act(y)" : "", parts.has_bending_z ? " act(z)" : "");
}

std::string head(const ProgramKind& kind, bool has_items) {
  const bool is_f64 = kind.precision == Precision::f64;
  std::string text = is_f64 ? "#pragma OPENCL EXTENSION cl_khr_fp64 : enable\n" : "";
  text += fmt::format(
      "#pragma OPENCL FP_CONTRACT OFF\n#define NUMBER {}\n#define W {}\n#define ALL_LANES {}u\n"
      "#define FMA(a, b, c) fma(a, b, c)\n#define GLOBAL global\n"
      // Structs of packs must stay in registers.
      "#undef inline\n#define inline inline __attribute__((always_inline))\n",
      is_f64 ? "double" : "float", kind.lanes, (1u << kind.lanes) - 1);
  if (has_items)
    text +=
        "#define REAL NUMBER\n#define SPLAT(a) ((NUMBER)(a))\n" + device_text("words_of_items.h");
  else
    text += vector_words(kind) + device_text("words_of_vectors.h");
  text += model_words(kind.model) + text_of(fmt::format("kernels/algebra/{}.h", name(kind.model))) +
          text_of("kernels/laws.h");
  text += text_of("kernels/stage_row/row_action.h");
  text += device_text("tables.h") + device_text("tables_of_device.h") +
          text_of("kernels/algebra/memory.h") + device_text("tuples.cl");
  return text;
}

} // namespace

std::string row_program(const ProgramKind& kind) {
  std::string text = head(kind, kind.has_items);
  std::string actions;
  for (const row_action action : kind.actions)
    actions += fmt::format(" | ((action) == {})", int(action));
  text += fmt::format("#define HAS(action) ((0{}) != 0)\n#define HAS_LINK_KINDS {}\n", actions,
                      int(kind.has_link_kinds));
  if (!kind.has_items) text += device_text("shifts_of_vectors.cl");
  text += text_of("kernels/rk_update/row_update.h");
  std::string cases;
  for (std::size_t n = 0; n < kind.terms.size(); ++n) {
    const Terms& t = kind.terms[n];
    text += fmt::format(
        "#define FLAGS ((term_flags){{{}, {}, {}, {}, {}, {}, {}, {}}})\n#define NAME(f) f##_{}\n",
        int(t.is_material), int(t.is_damped), int(t.is_bending), int(t.is_gyroscopic),
        int(t.is_tied), int(t.is_oblong), int(t.has_two_shears), int(t.has_pressure), n);
    text += pressure_words(kind.model, t) + device_text("row.cl") +
            device_text(kind.has_items ? "row_of_items.cl" : "row_of_vectors.cl") +
            "#undef FLAGS\n#undef NAME\n#undef HAS_PRESSURE\n#undef IS_BENT\n"
            "#undef PRESSURE_SIZE\n#undef COMPONENTS_OF_PRESSURE\n#undef PRESSURE_AT\n#undef "
            "PRESSURE_OF\n#undef BETWEEN\n";
    cases += fmt::format("  if (task->shape == {0}) return run_{0}(d, task, signals);\n", n);
  }
  text += fmt::format("static int run_task(device d, global const row_stage* task, global const "
                      "NUMBER* signals) {{\n"
                      "{}  return 1;\n}}\n",
                      cases);
  text += device_text("failures.cl");
  if (kind.tile.is_used())
    return text +
           fmt::format("#define WIDTH {}\n#define HEIGHT {}\n#define HALO {}\n", kind.tile.width,
                       kind.tile.height, kind.tile.halo()) +
           device_text("tiles.cl");
  text += device_text("rows.cl");
  if (!kind.has_items) text += device_text("passes.cl");
  if (kind.actions.contains(error_stage) || kind.actions.contains(kept_error))
    text += device_text("step_error.cl");
  return text;
}

std::string extra_link_program(const ProgramKind& kind) {
  return head(kind, true) + device_text("extra_links.cl");
}

} // namespace dss::opencl
