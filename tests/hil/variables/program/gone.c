/* Variables that need no place: one is only written, one never changes. */
static int gone = 3;
static int frozen = 17;
volatile int seen;
int names_fill(int x) {
  gone = x;
  seen = frozen + x;
  return 0;
}
