// until the folder has a real source
