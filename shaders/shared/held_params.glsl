// The parameter block as a private copy, filled by hold_params(), the first call of main(); from here on
// `params` means the copy. Read there, outside all control flow, each value is loaded once. A software
// device executes both sides of every branch and loads a value lane by lane wherever it is named: three
// times the time of a substep.
Params held_params;

void hold_params() { held_params = params; }

#define params held_params
