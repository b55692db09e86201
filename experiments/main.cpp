#include "experiments/command_line.h"

int main(int argc, char** argv) { return halfslope::command_line(argc, argv, halfslope::Catalogue::built_in()); }
