# cmake -DINPUT=FILE -DOUTPUT=FILE.cpp -DFUNCTION=NAME -P embed_file.cmake: a source that holds the bytes of a file, given by a
# function declared in report/viewer_template.h.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"report/viewer_template.h\"

namespace keyblock::report {

namespace {
constexpr unsigned char bytes_of_${FUNCTION}[] = {
${bytes}
};
}  // namespace

std::string_view ${FUNCTION}() {
  return {reinterpret_cast<const char*>(bytes_of_${FUNCTION}), sizeof bytes_of_${FUNCTION}};
}

}  // namespace keyblock::report
")
