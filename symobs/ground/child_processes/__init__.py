"""Child processes: started, asked, bounded in time and memory, ended, and replaced.

A call into FLINT hears no signal and aborts its process where memory ends, so that only another process can end it, or
survive it.  Whatever is to be bounded is therefore done by a child: `child` is the side of who asks, `inside` that of who
answers.
"""

#: Objects made before Python collects: imports and derivations make many that stay, and collecting among them as often
#: as usual takes a tenth of a short run.
COLLECTED_AFTER = 100_000
