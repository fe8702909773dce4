"""Running POV-Ray and vts on a scene, with what it costs."""
import glob
import os
import shutil
import subprocess
import tempfile
import threading

TOP = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
STDLIB = os.path.join(TOP, 'stdlib')
VTS = os.path.join(TOP, 'build', 'vts')


class Run:
    """What a program did: its status (None: it took longer than allowed), processor seconds of all its threads, what it said."""
    def __init__(self, status, seconds, said):
        self.status, self.seconds, self.said = status, seconds, said


def run(command, folder, timeout):
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        late = threading.Event()

        def stop():
            late.set()
            process.kill()
        timer = threading.Timer(timeout, stop)
        timer.start()
        _, status, used = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        log.seek(0)
        said = log.read().decode('latin-1')
    return Run(None if late.is_set() else process.returncode, used.ru_utime + used.ru_stime, said)


def fetched(scratch, suffix, out):
    """Films put a frame's number into the name: the one picture that was written goes to `out`. False when there is none."""
    found = sorted(glob.glob(os.path.join(scratch, 'picture*' + suffix)))
    if found:
        shutil.copyfile(found[0], out)
    return bool(found)


def povray(scene, out, size, options=(), quality=('+A0.1', '+AM1', '+R2'), threads=1, timeout=60, stdlib=False):
    """The picture as PPM of 16 bits, sRGB, in `out`. With `stdlib` vts's own include files go before POV-Ray's."""
    with tempfile.TemporaryDirectory() as scratch:
        done = run(['povray', '+I' + os.path.abspath(scene), '+L' + os.path.dirname(os.path.abspath(scene)), '+O%s/picture.ppm' % scratch,
                    '+FP16', '-D', '-V', '-P', '+W%d' % size[0], '+H%d' % size[1], '+WT%d' % threads, 'File_Gamma=srgb', *quality, *options],
                   STDLIB if stdlib else scratch, timeout)
        if not fetched(scratch, '.ppm', os.path.abspath(out)) and done.status == 0:
            done.status = 1
    return done


def vts(scene, out, size, options=(), program=VTS, threads=1, timeout=60):
    """The picture as floats (PFM) in `out`."""
    with tempfile.TemporaryDirectory() as scratch:
        done = run([os.path.abspath(program), 'render', os.path.abspath(scene), '-o', os.path.join(scratch, 'picture.pfm'),
                    '-s', '%dx%d' % size, '-t', str(threads), '--progress', 'none', '--allow-write', scratch, *options], scratch, timeout)
        if not fetched(scratch, '.pfm', os.path.abspath(out)) and done.status == 0:
            done.status = 1
    return done


def put(text, path):
    """Writes a table to the file, or to the terminal where none is named."""
    if path:
        with open(path, 'w', encoding='utf-8') as out:
            out.write(text)
    else:
        print(text, end='')
