# Makes templates.cpp of the files templates/*.toml.  cmake -DFOLDER=… -DOUT=… -P embed_templates.cmake
file(GLOB files ${FOLDER}/*.toml)
list(SORT files)
set(rows "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND rows "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
file(WRITE ${OUT} "#include \"templates.h\"

namespace keyblock::app {
namespace {

struct Template {
  std::string_view kind, text;
};

constexpr Template templates[] = {
${rows}};

}  // namespace

std::vector<std::string> template_kinds() {
  std::vector<std::string> kinds;
  for (const Template& known : templates) kinds.emplace_back(known.kind);
  return kinds;
}

std::string_view template_text(const std::string& kind) {
  for (const Template& known : templates) {
    if (known.kind == kind) return known.text;
  }
  return {};
}

}  // namespace keyblock::app
")
