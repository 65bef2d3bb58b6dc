// Prints what libsdformat makes of each URDF named on the command line, one after the other.
#include <iostream>
#include <sdf/sdf.hh>

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    sdf::SDFPtr sdf(new sdf::SDF());
    sdf::init(sdf);
    sdf::Errors errors;
    sdf::readFile(argv[i], sdf, errors);
    std::cout << sdf->Root()->ToString("") << '\0';
  }
}
